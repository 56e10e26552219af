// What each of a material's textures does: one quad, one texel or two, and the light that must come of it.
#include <pictures.h>

#include "scene/tangents.h"

namespace peelray {
namespace {

using TextureTest = PictureTest;

const Camera kFront = orthographic({0, 0, 2}, {0, 0, 0}, 1.8f);

double linear_code(double code) {
    return code <= 0.04045 * 255 ? code / 255 / 12.92 : std::pow((code / 255 + 0.055) / 1.055, 2.4);
}

TEST_F(TextureTest, EmissionIsTheFactorTimesTheTexture) {
    Stage stage;
    Material m = emitting({3, 1, 0.5f});
    m.emissive_texture = 0;
    stage.add(texture_square(), m);
    stage.scene.textures = {two_texels({255, 128, 10}, {0, 60, 200})};
    tally(render(stage, black, settings_for(kFront)), kFront, 1e-4,
          left_and_right({3, linear_code(128), 0.5 * linear_code(10)}, {0, linear_code(60), 0.5 * linear_code(200)}))
        .expect(0, 4000);
}

TEST_F(TextureTest, EachTextureHasItsOwnCoordinates) {
    // Emission shows set 1, which runs the other way; the base colour set 0, turned by a quarter: left becomes top.
    Stage stage;
    Material m = emitting(glm::vec3(1));
    m.base_color = glm::vec3(1);
    m.base_color_texture = 0;
    m.base_color_texture.uv_matrix = glm::mat2(0, 1, 1, 0);  // u and v change places
    m.emissive_texture = 1;
    m.emissive_texture.uv_set = 1;
    Primitive quad = texture_square();
    quad.more_uvs = {{{1, 1}, {0, 1}, {0, 0}, {1, 0}}};
    stage.add(texture_square(), unlit({1, 1, 1}));  // hidden, and without a second set
    for (glm::vec3& p : stage.scene.meshes[0].primitives[0].positions) p.z = -1;
    stage.add(quad, m);
    stage.scene.textures = {two_texels({255, 0, 0}, {0, 255, 0}), two_texels({0, 0, 255}, {0, 0, 51})};
    tally(render(stage, white, settings_for(kFront)), kFront, 2e-3,
          [](const ViewRay& ray) -> std::optional<glm::dvec3> {
              if (std::abs(ray.origin.x) < 1e-3 || std::abs(ray.origin.y) < 1e-3) return {};
              const bool top = ray.origin.y > 0, left = ray.origin.x < 0;
              return glm::dvec3(top, !top, left ? linear_code(51) : 1);
          })
        .expect(0, 4000);
}

TEST_F(TextureTest, OffsetAndScaleComeAfterTheSet) {
    Stage stage;
    Material m = emitting(glm::vec3(1));
    m.emissive_texture = 0;
    m.emissive_texture.uv_matrix = glm::mat2(2, 0, 0, 2);
    m.emissive_texture.uv_offset = {0.5f, 0.25f};
    stage.add(texture_square(), m);
    stage.scene.textures = {two_texels({255, 255, 255}, {0, 0, 0})};
    tally(render(stage, black, settings_for(kFront)), kFront, 1e-4,
          [](const ViewRay& ray) -> std::optional<glm::dvec3> {
              const double u = (ray.origin.x + 1) / 2 * 2 + 0.5, f = u - std::floor(u);
              if (std::min({std::abs(f), std::abs(f - 0.5), std::abs(f - 1)}) < 1e-3) return {};
              return glm::dvec3(f < 0.5);
          })
        .expect(0, 3900);
}

TEST_F(TextureTest, MetalIsTheTexturesChannel) {
    // Metal has no diffuse light, and a mirror no highlight of the sun.
    Stage stage;
    Material m = lambert({0.8f, 0.6f, 0.4f});
    m.roughness = 0;
    m.metallic = 1;
    m.metallic_texture = 0;
    m.metallic_texture.channel = 2;
    stage.add(texture_square(), m);
    stage.sun({0, 0, -1}, glm::vec3(2));
    stage.scene.textures = {two_texels({255, 255, 0}, {0, 0, 255})};
    tally(render(stage, black, settings_for(kFront)), kFront, 1e-4,
          left_and_right(2 / kPi * glm::dvec3(0.8f, 0.6f, 0.4f), glm::dvec3(0)))
        .expect(0, 4000);
}

TEST_F(TextureTest, RoughnessIsTheFactorTimesTheTexture) {
    // Seen and lit along the normal GGX reflects 1 / (4 pi alpha²).
    Stage stage;
    Material m = metal("rough", glm::vec3(1));
    m.roughness = 0.9f;
    m.roughness_texture = 0;
    m.roughness_texture.channel = 1;
    stage.add(texture_square(), m);
    stage.sun({0, 0, -1}, glm::vec3(1));
    stage.scene.textures = {two_texels({0, 255, 0}, {255, 128, 255})};
    const auto highlight = [](double roughness) { return glm::dvec3(1 / (4 * kPi * std::pow(roughness, 4))); };
    RenderSettings settings = settings_for(kFront);
    settings.energy_compensation = false;
    tally(render(stage, black, settings), kFront, 2e-3,
          left_and_right(highlight(double(0.9f)), highlight(double(0.9f) * 128 / 255)))
        .expect(0, 4000);
}

TEST_F(TextureTest, SpecularTexturesScaleTheReflection) {
    // A smooth dielectric along its normal reflects f0 of a white sky; its base is black.
    Stage stage;
    Material m = lambert({0, 0, 0});
    m.ior = 3;  // f0 = 1/4
    m.roughness = 0;
    m.specular = 0.8f;
    m.specular_color = {1, 2, 6};
    m.specular_texture = 0;
    m.specular_texture.channel = 3;
    m.specular_color_texture = 0;
    stage.add(texture_square(), m);
    stage.scene.textures = {two_texels({255, 128, 255, 255}, {188, 255, 0, 51})};
    tally(render(stage, white, settings_for(kFront)), kFront, 1e-4,
          left_and_right(0.8 * glm::dvec3(0.25, 0.5 * linear_code(128), 1),
                         0.16 * glm::dvec3(0.25 * linear_code(188), 0.5, 0)))
        .expect(0, 4000);
}

TEST_F(TextureTest, OcclusionDarkensTheSkyAlone) {
    Stage stage;
    Material m = lambert({0.5f, 0.5f, 0.5f});
    m.occlusion_texture = 0;
    m.occlusion_strength = 0.5f;
    stage.add(texture_square(), m);
    stage.scene.textures = {two_texels({51, 255, 255}, {204, 0, 0})};
    tally(render(stage, white, settings_for(kFront)), kFront, 2e-3,
          left_and_right(glm::dvec3(0.5 * (1 - 0.5 * 0.8)), glm::dvec3(0.5 * (1 - 0.5 * 0.2))))
        .expect(0, 4000);
    stage.sun({0, 0, -1}, glm::vec3(1));
    tally(render(stage, black, settings_for(kFront)), kFront, 1e-4, [](const ViewRay&) {
        return glm::dvec3(0.5 / kPi);
    }).expect(0, 4000);
}

TEST_F(TextureTest, OneImageServesAsColourAndAsNumbers) {
    Stage stage;
    Material m = lambert({1, 1, 1});
    m.base_color_texture = 0;
    m.occlusion_texture = 0;
    stage.add(texture_square(), m);
    stage.scene.textures = {two_texels({128, 128, 128}, {200, 200, 200})};
    tally(render(stage, white, settings_for(kFront)), kFront, 2e-3,
          left_and_right(glm::dvec3(linear_code(128) * 128 / 255), glm::dvec3(linear_code(200) * 200 / 255)))
        .expect(0, 4000);
}

TEST_F(TextureTest, SixteenBitsAreKept) {
    Stage stage;
    Material m = emitting(glm::vec3(1));
    m.emissive_texture = 0;
    stage.add(texture_square(), m);
    Texture t = two_texels({}, {});
    t.texels.clear();
    // The first of three steps of a 256th, and green alone: channels keep their places.
    t.deep_texels = {0xFFFF'4000'4055'40AAull, 0xFFFF'0000'8000'0000ull};
    stage.scene.textures = {t};
    const auto level = [](double code) { return linear_code(code / 65535 * 255); };
    tally(render(stage, black, settings_for(kFront)), kFront, 2e-5,
          left_and_right({level(0x40AA), level(0x4055), level(0x4000)}, {0, level(0x8000), 0}))
        .expect(0, 4000);
}

TEST_F(TextureTest, TransmissionIsTheFactorTimesTheTexture) {
    Stage stage;
    Material m = thin_glass(1);
    m.transmission = 0.5f;
    m.transmission_texture = 0;
    stage.add(texture_square(), m);
    stage.add(parallelogram({-3, -3, -1}, {6, 0, 0}, {0, 6, 0}), unlit({0.9f, 0.5f, 0.1f}));
    stage.scene.textures = {two_texels({255, 0, 0}, {51, 255, 255})};
    const glm::dvec3 behind(0.9f, 0.5f, 0.1f);
    tally(render(stage, black, settings_for(kFront)), kFront, 1e-4, left_and_right(0.5 * behind, 0.1 * behind))
        .expect(0, 4000);

    // The same for the sun's light on what is behind: the pane stands between them.
    Stage shadowed;
    shadowed.add(texture_square(), m);
    shadowed.add(parallelogram({-3, -3, -1}, {6, 0, 0}, {0, 6, 0}), lambert({1, 1, 1}));
    shadowed.sun({0, 0, -1}, glm::vec3(1));
    shadowed.scene.textures = stage.scene.textures;
    const Camera behind_it = orthographic({0, -8, 4}, {0, 0, -1}, 1.2f);
    tally(render(shadowed, black, settings_for(behind_it)), behind_it, 1e-4,
          [](const ViewRay& ray) -> std::optional<glm::dvec3> {
              const glm::dvec3 p = ray.at_plane(2, -1), q = ray.at_plane(2, 0);
              if (std::abs(p.x) < 0.01 || std::max(std::abs(q.x), std::abs(q.y)) < 1.01) return {};
              if (std::max(std::abs(p.x), std::abs(p.y)) > 0.99) return {};
              return glm::dvec3((p.x < 0 ? 0.5 : 0.1) / kPi);
          })
        .expect(0, 500);
}

// --- Normals ---

/// One texel: the normal that it stands for has these parts along tangent, bitangent and normal.
Texture normal_texel(const glm::dvec3& parts) {
    Texture t;
    t.width = t.height = 1;
    t.deep_texels = {0};
    for (int i = 0; i < 3; i++) t.deep_texels[0] |= uint64_t(std::lround((parts[i] * 0.5 + 0.5) * 65535)) << 16 * i;
    return t;
}

struct Facing {
    const char* name;
    glm::mat2 uv;        ///< what the square's coordinates become
    glm::mat4 placed;    ///< where the node stands
    glm::vec3 expected;  ///< the normal of the texel (sin 10°, sin 20°, rest), in the world
};

TEST_F(TextureTest, NormalsTurnWithTheTexture) {
    const double a = std::sin(glm::radians(10.0)), b = std::sin(glm::radians(20.0)), c = std::sqrt(1 - a * a - b * b);
    const glm::mat4 one(1), half_turn = glm::mat4(glm::vec4(-1, 0, 0, 0), {0, -1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1});
    const glm::mat4 mirrored = glm::mat4(glm::vec4(-1, 0, 0, 0), {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1});
    const float x = float(a), y = float(b), z = float(c);
    const Facing cases[] = {
        {"as it is", glm::mat2(1), one, {x, y, z}},  // red to the right, green to the image's first row
        {"u mirrored", glm::mat2(-1, 0, 0, 1), one, {-x, y, z}},
        {"v mirrored", glm::mat2(1, 0, 0, -1), one, {x, -y, z}},
        {"half a turn", glm::mat2(-1, 0, 0, -1), one, {-x, -y, z}},
        {"u and v exchanged", glm::mat2(0, 1, 1, 0), one, {-y, -x, z}},
        {"stretched", glm::mat2(7, 0, 0, 0.5f), one, {x, y, z}},
        {"the node turned", glm::mat2(1), half_turn, {-x, -y, z}},
        {"the node mirrored", glm::mat2(1), mirrored, {-x, y, z}},
        {"both mirrored", glm::mat2(-1, 0, 0, 1), mirrored, {x, y, z}},
    };
    const Environment image = direction_image();
    for (const Facing& facing : cases)
        for (const bool behind : {false, true}) {
            SCOPED_TRACE(fmt::format("{}{}", facing.name, behind ? ", from behind" : ""));
            Stage stage;
            Material m = plane_mirror();
            m.normal_texture = 0;
            stage.add(texture_square(), m);
            stage.scene.textures = {normal_texel({a, b, c})};
            for (glm::vec2& uv : stage.scene.meshes[0].primitives[0].uvs) uv = facing.uv * uv;
            stage.scene.nodes[0].local = facing.placed;
            complete_tangents(stage.scene);
            const Camera camera = orthographic({0, 0, behind ? -2 : 2}, {0, 0, 0}, 1.8f);
            const glm::dvec3 n = glm::normalize(glm::dvec3(facing.expected));
            tally(render(stage, image, settings_for(camera, 16)), camera, 0.01, [&](const ViewRay& ray) {
                return light_of(ray.direction - 2 * glm::dot(ray.direction, n) * n);
            }).expect(0, 256);
        }
}

TEST_F(TextureTest, NormalScaleTiltsAndTangentsOfTheFileCount) {
    Stage stage;
    Material m = plane_mirror();
    m.normal_texture = 0;
    m.normal_scale = 0.5f;
    Primitive quad = texture_square();
    quad.tangents.assign(4, glm::vec4(0, 1, 0, -1));  // not those of the coordinates
    stage.add(quad, m);
    const double a = std::sin(glm::radians(20.0)), c = std::cos(glm::radians(20.0));
    stage.scene.textures = {normal_texel({a, 0, c})};
    complete_tangents(stage.scene);
    const glm::dvec3 n = glm::normalize(glm::dvec3(0, a / 2, c));
    tally(render(stage, direction_image(), settings_for(kFront, 16)), kFront, 0.01, [&](const ViewRay& ray) {
        return light_of(ray.direction - 2 * glm::dot(ray.direction, n) * n);
    }).expect(0, 256);
}

TEST_F(TextureTest, TangentsMorphAndFollowTheirJoint) {
    const double a = std::sin(glm::radians(20.0)), c = std::cos(glm::radians(20.0));
    for (const bool skinned : {false, true}) {
        SCOPED_TRACE(skinned ? "skinned" : "morphed");
        Stage stage;
        Material m = plane_mirror();
        m.normal_texture = 0;
        stage.add(texture_square(), m);
        stage.scene.textures = {normal_texel({a, 0, c})};
        Primitive& quad = stage.scene.meshes[0].primitives[0];
        complete_tangents(stage.scene);
        if (skinned) {  // the joint turns the square by a quarter: the tangent comes to point up
            quad.joints.assign(4, {});
            for (JointWeights& vertex : quad.joints) vertex.weights[0] = 1;
            stage.scene.skins.push_back({"skin", {1}, {glm::mat4(1)}});
            stage.scene.nodes[0].skin = 0;
            Node joint;
            joint.local = glm::mat4(glm::vec4(0, 1, 0, 0), {-1, 0, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1});
            stage.scene.nodes.push_back(joint);
        } else {
            MorphTarget target;
            target.tangents.assign(4, glm::vec3(-1, 1, 0));
            quad.targets.push_back(target);
            stage.scene.meshes[0].weights = {1};
        }
        const glm::dvec3 n(0, a, c);
        tally(render(stage, direction_image(), settings_for(kFront, 16)), kFront, 0.01, [&](const ViewRay& ray) {
            return light_of(ray.direction - 2 * glm::dot(ray.direction, n) * n);
        }).expect(0, 256);
    }
}

/// Stripes of one texel, 255 and 0, along u; as many texels along v.
Texture stripes(uint32_t size) {
    Texture t;
    t.width = t.height = size;
    for (uint32_t i = 0; i < size * size; i++) t.texels.push_back(i % 2 ? 0xff000000u : 0xffffffffu);
    return t;
}

Material shows(int texture) {
    Material m = unlit({1, 1, 1});
    m.base_color_texture = texture;
    return m;
}

TEST_F(TextureTest, SmallTexturesAreMeans) {
    // A pixel covers four texels: level 2, which is one grey in linear light. Magnified, or of level 0 alone, it is
    // not.
    Stage stage;
    stage.add(texture_square(), shows(0));
    stage.scene.textures = {stripes(256)};
    const Camera camera = orthographic({0, 0, 2}, {0, 0, 0}, 1.9f);
    const RenderSettings settings = settings_for(camera, 60);
    const auto grey = [](const ViewRay&) { return glm::dvec3(0.5); };
    tally(render(stage, black, settings), camera, 4e-3, grey)  // 0.5 has no code of its own
        .expect(0, 3600);
    for (const bool none : {false, true}) {
        stage.scene.textures[0].mipmaps = none ? Texture::Mipmaps::none : Texture::Mipmaps::linear;
        RenderSettings close = settings;
        if (!none) close.camera.orthographic_height = 0.3f;
        const Tally wrong = tally(render(stage, black, close), close.camera, 0.02, grey);
        EXPECT_GT(wrong.wrong, 1000u) << none;
    }
}

TEST_F(TextureTest, LevelsMeetAtTheirMean) {
    // Red in level 0 alone, which no pixel shows by itself: half way between levels 0 and 1 half of it is left.
    Stage stage;
    stage.add(texture_square(), shows(0));
    stage.scene.textures = {stripes(64)};
    const auto spread_at = [&](double texels) {
        const Camera camera = orthographic({0, 0, 2}, {0, 0, 0}, float(texels));
        const RenderResult picture = render(stage, black, settings_for(camera, 32));
        double least = 1, most = 0;
        for (const glm::vec4& p : picture.radiance) {
            least = std::min(least, double(p.x));
            most = std::max(most, double(p.x));
        }
        return most - least;
    };
    EXPECT_GT(spread_at(0.9), 0.85);   // magnified
    EXPECT_LT(spread_at(1.99), 0.02);  // almost level 1
    EXPECT_NEAR(spread_at(std::sqrt(2)), 0.5, 0.03);
}

TEST_F(TextureTest, MirrorsSeeWhatIsFarBlurred) {
    // The way over the mirror counts: close to it the stripes are resolved, as far again behind the camera they are
    // not.
    for (const double distance : {0.2, 40.0}) {
        Stage stage;
        const float size = float(distance) + 1;
        Primitive wall = faces({{{size, -size, float(distance)},
                                 {-size, -size, float(distance)},
                                 {-size, size, float(distance)},
                                 {size, size, float(distance)}}});
        for (const glm::vec3& p : wall.positions) wall.uvs.push_back(glm::vec2(p) * 2.0f);  // a stripe is 1/32 wide
        stage.add(wall, shows(0));
        stage.scene.materials[0].double_sided = true;
        stage.add(parallelogram({-9, -9, 0}, {18, 0, 0}, {0, 18, 0}), plane_mirror());
        stage.scene.textures = {stripes(16)};
        const Camera camera = perspective({0, 0, 0.15f}, {0, 0, 0}, 30);
        const RenderResult picture = render(stage, black, settings_for(camera, 48));
        double mean = 0, square = 0;
        for (const glm::vec4& p : picture.radiance) {
            mean += p.x / double(picture.radiance.size());
            square += p.x * p.x / double(picture.radiance.size());
        }
        EXPECT_NEAR(mean, 0.5, 0.06) << distance;
        const double deviation = std::sqrt(square - mean * mean);
        if (distance > 1)
            EXPECT_LT(deviation, 0.02);
        else
            EXPECT_GT(deviation, 0.2);
    }
}

TEST_F(TextureTest, SamplesShareThePixel) {
    // A pixel of 1.8 texels is blurred, but each of four samples stands for 0.9: level 0 serves.
    Stage stage;
    stage.add(texture_square(), shows(0));
    stage.scene.textures = {stripes(64)};
    RenderSettings settings = settings_for(orthographic({0, 0, 2}, {0, 0, 0}, 1.8f), 32);
    for (const uint32_t spp : {1u, 4u}) {
        settings.spp = spp;
        stage.scene.textures[0].mipmaps = Texture::Mipmaps::linear;
        const RenderResult blurred = render(stage, black, settings);
        stage.scene.textures[0].mipmaps = Texture::Mipmaps::none;
        const size_t wrong = tally(blurred, render(stage, black, settings), 1e-5).wrong;
        if (spp == 1)
            EXPECT_GT(wrong, 900u);
        else
            EXPECT_EQ(wrong, 0u);
    }
}

}  // namespace
}  // namespace peelray
