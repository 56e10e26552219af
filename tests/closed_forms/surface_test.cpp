// Textures, vertex colours, switches, and what must never be seen: NaN.
#include <pictures.h>

namespace peelray {
namespace {

using SurfaceTest = PictureTest;

double linear(double code) {
    return code <= 0.04045 * 255 ? code / 255 / 12.92 : std::pow((code / 255 + 0.055) / 1.055, 2.4);
}

const uint8_t kTexels[2][3][3] = {{{255, 0, 40}, {10, 128, 200}, {90, 60, 30}},
                                  {{0, 255, 5}, {180, 188, 70}, {33, 66, 99}}};

Texture small_texture(Texture::Wrap u, Texture::Wrap v, bool nearest) {
    Texture t;
    t.width = 3;
    t.height = 2;
    for (const auto& row : kTexels)
        for (const auto& texel : row) t.texels.push_back(0xff000000u | texel[0] | texel[1] << 8 | texel[2] << 16);
    t.wrap_u = u;
    t.wrap_v = v;
    t.nearest = nearest;
    return t;
}

/// Texel i of n, by the mode's meaning: periodic, mirrored at every border, the border for ever.
int wrap(int i, int n, Texture::Wrap mode) {
    if (mode == Texture::Wrap::clamp) return std::min(std::max(i, 0), n - 1);
    const int period = int(std::floor(double(i) / n)), rest = i - period * n;
    return mode == Texture::Wrap::mirror && period % 2 != 0 ? n - 1 - rest : rest;
}
glm::dvec3 texel(int x, int y, Texture::Wrap u, Texture::Wrap v) {
    const auto& t = kTexels[wrap(y, 2, v)][wrap(x, 3, u)];
    return {linear(t[0]), linear(t[1]), linear(t[2])};
}

TEST_F(SurfaceTest, TexturesWrapAndFilter) {
    using enum Texture::Wrap;
    // uv from (-2.3, -1.8) at the top left to (2.7, 2.2): v grows downwards.
    Primitive quad = faces({{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}});
    quad.uvs = {{-2.3f, 2.2f}, {2.7f, 2.2f}, {2.7f, -1.8f}, {-2.3f, -1.8f}};
    const Camera camera = orthographic({0, 0, 2}, {0, 0, 0}, 2);
    for (const auto& [u, v] : {std::pair{repeat, mirror}, {mirror, clamp}, {clamp, repeat}})
        for (bool nearest : {true, false}) {
            SCOPED_TRACE(fmt::format("wrap {} {}, nearest {}", int(u), int(v), nearest));
            Stage stage;
            stage.add(quad, unlit({1, 1, 1}));
            stage.scene.materials[0].base_color_texture = 0;
            stage.scene.textures.push_back(small_texture(u, v, nearest));
            tally(render(stage, black, settings_for(camera)), camera, 1e-3,
                  [&](const ViewRay& ray) -> std::optional<glm::dvec3> {
                      const double x = (-2.3 + (ray.origin.x + 1) / 2 * 5) * 3,
                                   y = (-1.8 + (1 - ray.origin.y) / 2 * 4) * 2;
                      if (nearest) {
                          if (std::abs(x - std::round(x)) < 1e-3 || std::abs(y - std::round(y)) < 1e-3) return {};
                          return texel(int(std::floor(x)), int(std::floor(y)), u, v);
                      }
                      const int i = int(std::floor(x - 0.5)), j = int(std::floor(y - 0.5));
                      const double fx = x - 0.5 - i, fy = y - 0.5 - j;
                      return glm::mix(glm::mix(texel(i, j, u, v), texel(i + 1, j, u, v), fx),
                                      glm::mix(texel(i, j + 1, u, v), texel(i + 1, j + 1, u, v), fx), fy);
                  })
                .expect(0, 3900);
        }
}

TEST_F(SurfaceTest, SecondTextureIsFoundAndTinted) {
    Stage stage;
    stage.add(faces({{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}}), unlit({0.5f, 2, 1}));
    stage.scene.meshes[0].primitives[0].uvs.assign(4, glm::vec2(0.5f, 0.25f));
    stage.scene.materials[0].base_color_texture = 1;
    stage.scene.textures = {small_texture(Texture::Wrap::repeat, Texture::Wrap::repeat, true),
                            small_texture(Texture::Wrap::repeat, Texture::Wrap::repeat, true)};
    stage.scene.textures[1].texels[1] = 0xff8040bc;  // rgb 188, 64, 128
    const Camera camera = orthographic({0, 0, 2}, {0, 0, 0}, 1.8f);
    tally(render(stage, black, settings_for(camera, 16)), camera, 1e-5, [](const ViewRay&) {
        return glm::dvec3(0.5 * linear(188), 2 * linear(64), linear(128));
    }).expect(0, 256);
}

TEST_F(SurfaceTest, VertexColoursInterpolate) {
    Stage stage;
    Primitive quad = faces({{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}});
    for (const glm::vec3& p : quad.positions) quad.colors.push_back({p.x + 1, p.y + 1, 1, 1});
    stage.add(quad, unlit({0.5f, 0.25f, 0.75f}));
    stage.add(parallelogram({-3, -3, -1}, {6, 0, 0}, {0, 6, 0}), unlit({0.1f, 0.2f, 0.3f}));  // without colours: white
    const Camera camera = orthographic({0, 0, 2}, {0, 0, 0}, 3);
    tally(render(stage, black, settings_for(camera)), camera, 1e-4,
          [](const ViewRay& ray) -> std::optional<glm::dvec3> {
              const double x = ray.origin.x, y = ray.origin.y;
              if (std::abs(x) < 1 && std::abs(y) < 1) return glm::dvec3(0.5 * (x + 1), 0.25 * (y + 1), 0.75);
              return glm::dvec3(0.1f, 0.2f, 0.3f);
          })
        .expect(0, 4096);
}

/// Left: a mirror, middle: a pane of glass over the floor, right: the floor with a box that shadows it.
class SwitchTest : public PictureTest {
  protected:
    struct Colors {
        glm::dvec3 mirror, glass, shadow;
    };
    Colors colors(const RenderSettings& settings) {
        Stage stage;
        stage.add(ground(4), lambert({1, 1, 1}));
        stage.add(parallelogram({-3, 0.1f, 1}, {2, 0, 0}, {0, 0, -2}), plane_mirror());
        stage.add(parallelogram({-0.5f, 0.5f, 1}, {1, 0, 0}, {0, 0, -2}), thin_glass());
        stage.add(parallelogram({-9, 20, 9}, {0, 0, -18}, {18, 0, 0}), unlit({0, 0, 3}));  // a ceiling above the camera
        stage.add(box({2, 0.5f, -1}, {2.5f, 1, 1}), unlit({1, 0, 0}));
        stage.sun({1, -1, 0}, {2, 2, 2});
        // The ceiling must not shadow everything: the sun is a lamp below it.
        stage.scene.lights.clear();
        stage.lamp({-2, 3.5f, 0}, {40, 40, 40});
        const RenderResult picture = render(stage, color_environment({0, 1, 0}), settings);
        return {radiance_at(picture, 16, 32), radiance_at(picture, 32, 32), radiance_at(picture, 58, 32)};
    }
    RenderSettings settings_ = settings_for(from_above(8), 64);  // 1/8 unit a pixel
};

TEST_F(SwitchTest, EffectsGoOffOneByOne) {
    settings_.reflection = settings_.refraction = settings_.shadow = true;
    const Colors all = colors(settings_);
    EXPECT_TRUE(near(all.mirror, {0, 0, 3}, 1e-4)) << text(all.mirror);
    const double lit_by_sky = 1;  // green: the environment's irradiance over pi
    EXPECT_TRUE(near(all.shadow, {0, lit_by_sky, 0}, 0.02)) << text(all.shadow);
    const double r = 0.04, pane = 2 * r / (1 + r);
    EXPECT_NEAR(all.glass.z - all.glass.x, pane * 3, 0.01) << text(all.glass);  // the ceiling in the pane
    EXPECT_GT(all.glass.x, 0.5);                                                // the lit floor through the pane

    settings_.reflection = false;
    const Colors no_reflection = colors(settings_);
    EXPECT_TRUE(near(no_reflection.mirror, {0, 1, 0}, 1e-4)) << text(no_reflection.mirror);
    EXPECT_NEAR(no_reflection.glass.y - all.glass.y, pane, 0.01);
    EXPECT_TRUE(near(no_reflection.shadow, all.shadow, 1e-5));

    settings_.reflection = true;
    settings_.refraction = false;
    const Colors no_refraction = colors(settings_);
    EXPECT_TRUE(near(no_refraction.mirror, all.mirror, 1e-5));
    EXPECT_TRUE(near(no_refraction.glass, {0, 1 - pane, pane * 3}, 1e-3)) << text(no_refraction.glass);

    settings_.refraction = true;
    settings_.shadow = false;
    const Colors no_shadow = colors(settings_);
    const glm::dvec3 to_lamp(-2 - 3.3125, 3.5, 0.0625);
    EXPECT_NEAR(no_shadow.shadow.x, 40 * 3.5 / std::pow(glm::length(to_lamp), 3) / kPi, 0.01);
    EXPECT_TRUE(near(no_shadow.mirror, all.mirror, 1e-5));
}

TEST_F(SwitchTest, WithoutBouncesOnlyShadowsAreTraced) {
    settings_.bounces = 0;
    const Colors none = colors(settings_);
    EXPECT_TRUE(near(none.mirror, {0, 1, 0}, 1e-4)) << text(none.mirror);
    EXPECT_TRUE(near(none.glass, {0, 1, 0}, 1e-3)) << text(none.glass);
    EXPECT_TRUE(near(none.shadow, {0, 1, 0}, 0.02)) << text(none.shadow);
}

TEST_F(SwitchTest, WithoutTracingNothingIsTraced) {
    settings_.tracer = Tracer::none;
    const Colors none = colors(settings_);
    EXPECT_TRUE(near(none.mirror, {0, 1, 0}, 1e-4)) << text(none.mirror);
    EXPECT_TRUE(near(none.glass, {0, 1, 0}, 1e-3)) << text(none.glass);
    EXPECT_GT(none.shadow.x, 0.1);  // lit: no shadow
    // The same picture as with all effects off.
    RenderSettings off = settings_;
    off.tracer = Tracer::ldc;
    off.reflection = off.refraction = off.shadow = false;
    const Colors same = colors(off);
    EXPECT_TRUE(near(same.mirror, none.mirror, 1e-6) && near(same.glass, none.glass, 1e-6) &&
                near(same.shadow, none.shadow, 1e-6));
}

TEST_F(SurfaceTest, CarelessMeshesLeaveNoHoles) {
    // Zero normals, normals against the winding, triangles without area, a lamp on the surface: under a white sky every
    // surface pixel is bright; a NaN would have been stored as black.
    Stage stage;
    Primitive ball = sphere({-1.2f, 1, 0}, 1, 8), other = sphere({1.2f, 1, 0}, 1, 8);
    for (auto& n : ball.normals) n = glm::vec3(0);
    for (auto& n : other.normals) n = -n;
    for (uint32_t i = 0; i < 20; i++) other.triangles.push_back({i, i, i + 1});
    Material rough;
    rough.roughness = 0.5f;
    stage.add(ball, rough);
    stage.add(other, clear_glass());
    stage.add(ground(5), plane_mirror());
    stage.lamp({0, 0, 0}, {1, 1, 1});
    stage.lamp(ball.positions[ball.triangles[0].x], {1, 1, 1});
    RenderSettings settings = settings_for(perspective({1, 3, 6}, {0, 0.5f, 0}, 40), 96);
    for (uint32_t spp : {1u, 4u}) {
        settings.spp = spp;
        settings.ambient = false;
        const RenderResult picture = render(stage, white, settings);
        Tally result;
        for (const glm::vec4& p : picture.radiance)
            result.add(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z) && p.x > 0.5f,
                       [&] { return text(glm::dvec3(p)); });
        result.expect(0, 96 * 96);
    }
}

}  // namespace
}  // namespace peelray
