// Masked materials: holes that the camera, mirrors and lights see through.
#include <pictures.h>

namespace peelray {
namespace {

using MaskTest = PictureTest;

const glm::dvec3 kPane(0.7, 0.2, 0.1), kWall(0.1, 0.3, 0.8);

/// A pane in z = 0, 2 by 2 around the origin, in front of a wall in z = -1.
Stage pane_and_wall() {
    Stage stage;
    stage.add(parallelogram({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), masked(stage, unlit(glm::vec3(kPane))));
    stage.add(parallelogram({-90, -90, -1}, {180, 0, 0}, {0, 180, 0}), unlit(glm::vec3(kWall)));
    return stage;
}
std::optional<glm::dvec3> pane_or_wall(const glm::dvec3& p) {
    if (std::max(std::abs(p.x), std::abs(p.y)) > 0.999) return {};
    const auto whole = whole_at({(p.x + 1) / 2, (p.y + 1) / 2});
    return whole ? std::optional(*whole ? kPane : kWall) : std::nullopt;
}

TEST_F(MaskTest, TheCameraSeesThroughHoles) {
    const Stage stage = pane_and_wall();
    for (const Camera& camera :
         {perspective({0.3f, 0.2f, 2.4f}, {0, 0, 0}, 45), perspective({2, 0.4f, 0.7f}, {0, 0, 0}, 60),
          orthographic({1, -0.7f, 2}, {0, 0, 0}, 2), perspective({-0.1f, 0.2f, 0.3f}, {0, 0.3f, 0}, 90)}) {
        RenderSettings settings = settings_for(camera, 128);
        settings.aovs = true;
        const RenderResult picture = render(stage, black, settings);
        tally(picture, camera, 1e-5, [&](const ViewRay& ray) {
            return pane_or_wall(ray.at_plane(2, 0));
        }).expect(0, 4000);
        for (size_t i = 0; i < picture.radiance.size(); i++) {
            if (picture.radiance[i].x > 0.5f) {
                EXPECT_LT(picture.aovs.triangle[i], 2);
            }
        }
    }
}

TEST_F(MaskTest, EverySampleOfAPixelIsTestedAtItsPlace) {
    const Stage stage = pane_and_wall();
    RenderSettings settings = settings_for(orthographic({0, 0, 2}, {0, 0, 0}, 1.9f), 64);
    settings.spp = 16;
    const RenderResult picture = render(stage, black, settings);
    // The mean over the picture is that of the share that is there.
    glm::dvec3 sum(0), expected(0);
    for (const glm::vec4& pixel : picture.radiance) sum += glm::dvec3(pixel) / 4096.0;
    for (int i = 0; i < 512 * 512; i++) {
        const glm::dvec2 p = (glm::dvec2(i % 512 + 0.5, i / 512 + 0.5) / 512.0 - 0.5) * 1.9;
        expected += (whole_at((p + 1.0) / 2.0, 0).value() ? kPane : kWall) / (512.0 * 512.0);
    }
    EXPECT_LT(glm::length(sum - expected), 2e-3) << text(sum) << text(expected);
}

TEST_F(MaskTest, MirrorsShowHoles) {
    Stage stage = pane_and_wall();
    stage.add(parallelogram({-4, -4, 3}, {0, 8, 0}, {8, 0, 0}), plane_mirror());  // faces -z
    const Camera camera = perspective({0.2f, 0.3f, 1.5f}, {0, 0, 3}, 50);
    tally(render(stage, black, settings_for(camera, 128)), camera, 1e-5,
          [](const ViewRay& ray) -> std::optional<glm::dvec3> {
              const glm::dvec3 at = ray.at_plane(2, 3);
              const ViewRay mirrored{at, ray.direction * glm::dvec3(1, 1, -1)};
              return pane_or_wall(mirrored.at_plane(2, 0));
          })
        .expect(0, 3000);
}

/// The floor's light under a sun from straight above, with a pane between them.
void expect_light_through(const RenderResult& picture, const Camera& camera, size_t at_least) {
    tally(picture, camera, 1e-3, [](const ViewRay& ray) -> std::optional<glm::dvec3> {
        const glm::dvec3 p = ray.at_plane(1, 0);
        if (std::max(std::abs(p.x), std::abs(p.z)) > 0.999) return {};
        const auto whole = whole_at({(p.x + 1) / 2, (1 - p.z) / 2});
        return whole ? std::optional(glm::dvec3(*whole ? 0 : 1)) : std::nullopt;
    }).expect(0, at_least);
}

TEST_F(MaskTest, LightFallsThroughHoles) {
    for (const bool glass : {false, true}) {
        SCOPED_TRACE(glass);
        Stage stage;
        stage.add(ground(3), lambert({1, 1, 1}));
        stage.add(parallelogram({-1, 1, 1}, {2, 0, 0}, {0, 0, -2}), masked(stage, lambert({1, 0, 0})));
        if (glass) stage.add(sphere({8, 1, 8}, 0.5f, 6), clear_glass());
        stage.sun({0, -1, 0}, glm::vec3(kPi));
        const Camera camera = orthographic({0, 0.9f, 0}, {0, 0, 0}, 2.2f, {0, 0, -1});
        expect_light_through(render(stage, black, settings_for(camera, 128)), camera, 9000);
    }
}

TEST_F(MaskTest, GlassWithHolesIsSeenThroughUntinted) {
    Stage stage;
    stage.add(ground(3), lambert({1, 1, 1}));
    Material pane = masked(stage, thin_glass(1));
    pane.base_color = glm::vec3(0);  // what passes through the glass itself is black
    stage.add(parallelogram({-1, 1, 1}, {2, 0, 0}, {0, 0, -2}), pane);
    stage.sun({0, -1, 0}, glm::vec3(kPi));
    const Camera camera = orthographic({0, 0.9f, 0}, {0, 0, 0}, 2.2f, {0, 0, -1});
    expect_light_through(render(stage, black, settings_for(camera, 128)), camera, 9000);
}

TEST_F(MaskTest, FactorVertexAlphaAndCutoff) {
    // Vertex alpha x from 0 to 1 across the pane, times a factor of 0.8: there from where 0.8 x reaches the cutoff.
    for (const float cutoff : {0.f, 0.2f, 0.5f, 0.79f, 0.9f}) {
        SCOPED_TRACE(cutoff);
        Stage stage;
        Primitive pane = parallelogram({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
        for (const glm::vec3& p : pane.positions) pane.colors.emplace_back(1, 1, 1, p.x);
        Material material = unlit(glm::vec3(kPane));
        material.alpha = 0.8f;
        material.alpha_cutoff = cutoff;
        stage.add(pane, material);
        stage.add(parallelogram({-5, -5, -1}, {10, 0, 0}, {0, 10, 0}), unlit(glm::vec3(kWall)));
        const Camera camera = perspective({0.4f, 0.6f, 1.2f}, {0.5f, 0.5f, 0}, 50);
        tally(render(stage, black, settings_for(camera)), camera, 1e-5,
              [&](const ViewRay& ray) -> std::optional<glm::dvec3> {
                  const glm::dvec3 p = ray.at_plane(2, 0);
                  if (p.x < 0.001 || p.x > 0.999 || p.y < 0.001 || p.y > 0.999) return {};
                  const double reach = 0.8 * p.x - double(cutoff);
                  return std::abs(reach) < 1e-4 ? std::nullopt : std::optional(reach > 0 ? kPane : kWall);
              })
            .expect(0, 2000);
    }
}

TEST_F(MaskTest, TexturesRepeatMirrorAndClamp) {
    for (const Texture::Wrap wrap : {Texture::Wrap::repeat, Texture::Wrap::mirror, Texture::Wrap::clamp}) {
        SCOPED_TRACE(int(wrap));
        Stage stage;
        Primitive pane = parallelogram({-1, -1, 0}, {2, 0, 0}, {0, 2, 0});
        for (glm::vec2& uv : pane.uvs) uv = uv * 3.f - 1.f;
        stage.add(pane, masked(stage, unlit(glm::vec3(kPane))));
        stage.scene.textures[0].wrap_u = stage.scene.textures[0].wrap_v = wrap;
        stage.add(parallelogram({-5, -5, -1}, {10, 0, 0}, {0, 10, 0}), unlit(glm::vec3(kWall)));
        const Camera camera = orthographic({0, 0, 3}, {0, 0, 0}, 1.9f);
        tally(render(stage, black, settings_for(camera, 96)), camera, 1e-5,
              [&](const ViewRay& ray) -> std::optional<glm::dvec3> {
                  const glm::dvec3 p = ray.at_plane(2, 0);
                  glm::dvec2 uv = (glm::dvec2(p) + 1.0) / 2.0 * 3.0 - 1.0;
                  if (!whole_at(uv, 0.01)) return {};
                  for (int i = 0; i < 2; i++) {
                      if (wrap == Texture::Wrap::clamp) uv[i] = std::clamp(uv[i], 1e-6, 1 - 1e-6);
                      if (wrap == Texture::Wrap::mirror && (uv[i] < 0 || uv[i] > 1))
                          uv[i] = uv[i] < 0 ? -uv[i] : 2 - uv[i];
                  }
                  return whole_at(uv, 0).value() ? kPane : kWall;
              })
            .expect(0, 6000);
    }
}

TEST_F(MaskTest, HolesGoWithWhatIsTurnedMirroredAndMorphed) {
    // Three nodes that show one pane, the last one of a mesh that takes on another shape.
    Stage stage = pane_and_wall();
    Primitive& pane = stage.scene.meshes[0].primitives[0];
    pane.targets.push_back({{}, {}});
    for (const glm::vec3& p : pane.positions) pane.targets[0].positions.push_back({0.5f * p.x, 0, 0});
    stage.scene.nodes[0].weights = {1};
    glm::mat4 turned(1);  // a quarter turn and a reflection: x and y change places
    turned[0] = {0, 1, 0, 0};
    turned[1] = {1, 0, 0, 0};
    stage.scene.nodes[0].local = turned;
    const Camera camera = orthographic({0, 0, 3}, {0, 0, 0}, 1.9f);
    tally(render(stage, black, settings_for(camera, 96)), camera, 1e-5, [&](const ViewRay& ray) {
        const glm::dvec3 p = ray.at_plane(2, 0);
        return pane_or_wall({p.y / 1.5, p.x, 0});
    }).expect(0, 6000);
}

}  // namespace
}  // namespace peelray
