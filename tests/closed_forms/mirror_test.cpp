// A plane mirror shows the mirrored scene; two of them show as many images as there are bounces.
#include <pictures.h>

#include "scene/tangents.h"

namespace peelray {
namespace {

using MirrorTest = PictureTest;

Primitive mirrored(Primitive shape) {
    for (auto& p : shape.positions) p.z = -p.z;
    for (auto& n : shape.normals) n.z = -n.z;
    for (auto& t : shape.triangles) std::swap(t.y, t.z);
    return shape;
}

/// 8×8 texels without any symmetry.
Texture letter() {
    Texture t;
    t.width = t.height = 8;
    t.nearest = true;
    Random random(7);
    for (int i = 0; i < 64; i++) t.texels.push_back(0xff000000u | uint32_t(random.next() * 0xffffff));
    return t;
}

/// A world at z > 0 in front of the mirror plane z = 0, all of it beside or behind the camera; `other`: its mirror
/// image.
Stage world(bool other) {
    Stage stage;
    const auto add = [&](Primitive shape, const Material& m) { stage.add(other ? mirrored(shape) : shape, m); };
    add(box({-1.6f, -0.6f, 2.0f}, {-1.1f, 0.3f, 2.6f}), unlit({0.9f, 0.1f, 0.05f}));
    add(box({0.7f, -0.9f, 1.8f}, {1.0f, 1.3f, 2.0f}), unlit({0.1f, 0.7f, 0.2f}));
    add(box({-0.2f, 0.9f, 3.0f}, {0.6f, 1.2f, 3.3f}), unlit({0.1f, 0.2f, 0.9f}));
    add(parallelogram({-1.4f, 0.7f, 3.4f}, {0.9f, 0.1f, 0}, {0.1f, 0.8f, 0}), unlit({1, 1, 1}));
    stage.scene.materials.back().base_color_texture = 0;
    // Everything from textures: what it emits and how it is lit.
    Material full = lambert({0.8f, 0.9f, 1});
    full.ior = 1.5f;
    full.emissive = glm::vec3(0.3f);
    full.base_color_texture = full.emissive_texture = full.normal_texture = full.roughness_texture =
        full.occlusion_texture = 0;
    full.roughness_texture.channel = 2;
    add(parallelogram({-0.9f, -0.8f, 3.3f}, {0.1f, 0.6f, -0.2f}, {0.8f, 0, 0.1f}), full);
    add(sphere({0.1f, -0.4f, 2.6f}, 0.5f, 16), lambert({0.8f, 0.7f, 0.5f}));
    add(parallelogram({-3, -1, 4}, {6, 0, 0}, {0, 0, -3.5f}), lambert({0.6f, 0.6f, 0.7f}));
    add(parallelogram({-3, -1, 4}, {0, 4, 0}, {6, 0, 0}), lambert({0.7f, 0.5f, 0.6f}));
    stage.scene.textures.push_back(letter());
    complete_tangents(stage.scene);
    stage.lamp({1.5f, 2, other ? -1.5f : 1.5f}, {12, 11, 10});
    return stage;
}

/// Any picture, and the same seen in the mirror z = 0.
Environment marked_environment(bool other) {
    const uint32_t width = 64, height = 32;
    std::vector<glm::vec4> pixels(width * height);
    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < width; x++) {
            const double phi = ((x + 0.5) / width - 0.5) * 2 * kPi, theta = (y + 0.5) / height * kPi;
            glm::dvec3 d(std::sin(theta) * std::sin(phi), std::cos(theta), -std::sin(theta) * std::cos(phi));
            if (other) d.z = -d.z;
            pixels[y * width + x] = glm::vec4(glm::vec3(0.6 + 0.4 * d), 1);
        }
    return image_environment(width, height, pixels);
}

const Camera kCamera = perspective({0.3f, 0.2f, 1.2f}, {-0.1f, 0.1f, 0}, 75);
const Primitive kMirror = parallelogram({-4, -4, 0}, {8, 0, 0}, {0, 8, 0});

TEST_F(MirrorTest, ShowsTheMirroredScene) {
    Stage stage = world(false);
    stage.add(kMirror, plane_mirror());
    RenderSettings settings = settings_for(kCamera, 128);
    settings.cubes.ldc = 128;
    const RenderResult in_mirror = render(stage, marked_environment(false), settings);
    const RenderResult direct = render(world(true), marked_environment(true), settings);
    // Only silhouettes may differ: there a rounding decides what a pixel sees.
    tally(in_mirror, direct, 2e-3).expect(0.01, 128 * 128);
    EXPECT_GE(in_mirror.rays.reflection, 128u * 128u);

    // The comparison sees the lamp's shadows: without them it must fail.
    settings.shadow = false;
    const RenderResult without = render(stage, marked_environment(false), settings);
    EXPECT_GT(tally(without, direct, 2e-3).wrong, 128 * 128 / 50u);
}

TEST_F(MirrorTest, TintFollowsSchlick) {
    Stage stage;
    stage.add(kMirror, plane_mirror({0.9f, 0.5f, 0.2f}));
    const Camera camera = perspective({0, 0, 1}, {0.8f, 0.3f, 0}, 90);
    tally(render(stage, white, settings_for(camera)), camera, 1e-4,
          [&](const ViewRay& ray) -> std::optional<glm::dvec3> {
              const glm::dvec3 p = ray.at_plane(2, 0);
              if (ray.direction.z >= -1e-3 || std::abs(p.x) > 3.9 || std::abs(p.y) > 3.9) return {};
              const glm::dvec3 f0(0.9, 0.5, 0.2);
              return f0 + (1.0 - f0) * std::pow(1 + ray.direction.z, 5);
          })
        .expect(0, 3000);
}

TEST_F(MirrorTest, TwinTrianglesDoNotHitEachOther) {
    // A large triangle with both windings, seen close by near the origin: the position's rounding counts in the
    // corners.
    const auto z = [](float x, float y) { return 0.3f * x + 0.7f * y; };
    const glm::vec3 a(-1013, -997, z(-1013, -997)), b(1021, -1009, z(1021, -1009)), c(3, 1019, z(3, 1019));
    Stage stage;
    stage.add(faces({{a, b, c}}), plane_mirror({0.5f, 0.5f, 0.5f}));
    stage.add(faces({{c, b, a}}), plane_mirror({0.5f, 0.5f, 0.5f}));
    const Camera camera = perspective({0.03f, 0.03f, 0.5f}, {0, 0, 0}, 2);
    tally(render(stage, white, settings_for(camera)), camera, 1e-3,
          [&](const ViewRay& ray) -> std::optional<glm::dvec3> {
              // Half of the white sky and Schlick's rest; a second bounce between the twins would halve it again.
              const double cosine = std::abs(glm::dot(ray.direction, glm::normalize(glm::dvec3(-0.3, -0.7, 1))));
              return glm::dvec3(0.5 + 0.5 * std::pow(1 - cosine, 5));
          })
        .expect(0, 64 * 64);
}

/// Two mirrors at z = ±1 that face each other.
Stage hall(const glm::vec3& tint) {
    Stage stage;
    stage.add(parallelogram({-9, -3, -1}, {18, 0, 0}, {0, 6, 0}), plane_mirror(tint));
    stage.add(parallelogram({-9, -3, 1}, {0, 6, 0}, {18, 0, 0}), plane_mirror(tint));
    return stage;
}

TEST_F(MirrorTest, BouncesBoundTheImagesOfTwoMirrors) {
    Stage stage = hall({1, 1, 1});
    stage.add(box({0.56f, -0.5f, -0.04f}, {0.64f, 0.5f, 0.04f}), unlit({5, 0, 0}));
    RenderSettings settings = settings_for(perspective({0, 0, 0}, {0, 0, -1}, 60), 256);
    settings.height = 16;
    settings.camera.vertical_fov = 2 * std::atan(std::tan(glm::radians(30.f)) / 16);
    for (uint32_t bounces = 0; bounces <= 5; bounces++) {
        settings.bounces = bounces;
        const RenderResult picture = render(stage, white, settings);
        uint32_t images = 0;
        bool in_image = false;
        for (uint32_t x = 128; x < 256; x++) {
            const bool red = radiance_at(picture, x, 8).x > 3;
            images += red && !in_image;
            in_image = red;
        }
        EXPECT_EQ(images, bounces);
    }
}

TEST_F(MirrorTest, EveryReflectionTints) {
    const Camera camera = perspective({0, 0, 0}, {0.2f, 0.9f, -1}, 60);
    RenderSettings settings = settings_for(camera);
    settings.bounces = 6;
    const RenderResult picture = render(hall(glm::vec3(0.5f)), white, settings);
    tally(picture, camera, 1e-4, [&](const ViewRay& ray) -> std::optional<glm::dvec3> {
        // Unfolded: the ray passes a mirror at |z| = 1, 3, 5 … as long as it stays inside |x| < 9, |y| < 3.
        const double reach =
            std::min(9 / std::abs(ray.direction.x), 3 / std::abs(ray.direction.y)) * std::abs(ray.direction.z);
        const double passed = (reach + 1) / 2, tint = 0.5 + 0.5 * std::pow(1 - std::abs(ray.direction.z), 5);
        if (std::abs(passed - std::round(passed)) < 1e-3) return {};
        return glm::dvec3(std::pow(tint, std::min(std::floor(passed), 7.0)));
    }).expect(0, 3500);
}

}  // namespace
}  // namespace peelray
