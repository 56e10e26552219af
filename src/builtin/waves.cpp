// A pool whose water is simulated, with bodies that float in it.
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "base/error.h"
#include "builtin/shapes.h"
#include "motion/simulation.h"

namespace peelray {
namespace {

constexpr float kPool = 4, kDepth = 0.9f, kRim = 0.28f;  // metres: side, depth, height of the rim above the water

/// (cells + 1)² vertices in rows along x, facing up.
Primitive sheet(uint32_t cells) {
    Primitive out;
    const uint32_t row = cells + 1;
    for (uint32_t z = 0; z < row; z++)
        for (uint32_t x = 0; x < row; x++) {
            out.positions.push_back(
                {kPool * (float(x) / float(cells) - 0.5f), 0, kPool * (float(z) / float(cells) - 0.5f)});
            out.normals.push_back({0, 1, 0});
        }
    for (uint32_t z = 0; z < cells; z++)
        for (uint32_t x = 0; x < cells; x++) {
            const uint32_t a = z * row + x, b = a + row;
            out.triangles.push_back({a, b, b + 1});
            out.triangles.push_back({a, b + 1, a + 1});
        }
    return out;
}

/// Some drops' rings that have spread already, so that the first picture shows water.
std::vector<float> start_heights(const Primitive& water) {
    const struct {
        glm::vec2 at;
        float radius, height, width;
    } rings[] = {{{-0.7f, 0.4f}, 0.75f, 0.035f, 0.11f},
                 {{0.9f, -0.8f}, 0.4f, 0.05f, 0.1f},
                 {{0.5f, 1.1f}, 1.15f, 0.022f, 0.13f}};
    std::vector<float> heights;
    for (const glm::vec3& p : water.positions) {
        float sum = 0;
        for (const auto& ring : rings) {
            const float q = (glm::length(glm::vec2(p.x, p.z) - ring.at) - ring.radius) / ring.width;
            sum += ring.height * std::cos(2.2f * q) * std::exp(-0.5f * q * q);
        }
        heights.push_back(sum);
    }
    return heights;
}

void add_pool(SceneBuilder& build) {
    Material tiles = matte("pool tiles", glm::vec3(1));
    tiles.base_color_texture = build.tiles(2, 0xF0E8DC, 0xD0A870, true);
    const float h = kPool / 2, top = kRim, low = -kDepth, stone_thick = 0.08f;
    const uint32_t tile = build.material(tiles);
    build.add("pool floor", parallelogram({-h, low, h}, {kPool, 0, 0}, {0, 0, -kPool}, 6), tile);
    const glm::vec3 up(0, kDepth + kRim - stone_thick, 0);
    const auto wall = [&](const char* name, const glm::vec3& corner, const glm::vec3& along) {
        Primitive shape = parallelogram(corner, along, up, 1);
        for (glm::vec2& uv : shape.uvs) uv *= glm::vec2(6, 6 * up.y / kPool);
        build.add(name, std::move(shape), tile);
    };
    wall("far wall", {-h, low, -h}, {kPool, 0, 0});
    wall("near wall", {h, low, h}, {-kPool, 0, 0});
    wall("left wall", {-h, low, h}, {0, 0, -kPool});
    wall("right wall", {h, low, -h}, {0, 0, kPool});
    const uint32_t stone = build.material(matte("stone", {0.62f, 0.58f, 0.52f}));
    const float rim = 0.35f;
    build.add("far rim", box({-h - rim, top - stone_thick, -h - rim}, {h + rim, top, -h}), stone);
    build.add("near rim", box({-h - rim, top - stone_thick, h}, {h + rim, top, h + rim}), stone);
    build.add("left rim", box({-h - rim, top - stone_thick, -h}, {-h, top, h}), stone);
    build.add("right rim", box({h, top - stone_thick, -h}, {h + rim, top, h}), stone);
    build.add("mast", box({-1.75f, top, -2.3f}, {-1.6f, top + 1.7f, -2.15f}),
              build.material(matte("red mast", {0.75f, 0.1f, 0.06f})));
    build.add("ball on the rim", sphere({1.2f, top + 0.32f, -2.17f}, 0.32f, 12),
              build.material(metal("brass", {0.93f, 0.74f, 0.35f})));
}

/// Adds an ellipsoid of one colour to a shape that has vertex colours.
void add_ellipsoid(Primitive& out, const glm::vec3& centre, const glm::vec3& radii, const glm::vec3& color,
                   uint32_t n) {
    const Primitive ball = sphere({0, 0, 0}, 1, n);
    const auto first = uint32_t(out.positions.size());
    for (size_t i = 0; i < ball.positions.size(); i++) {
        out.positions.push_back(centre + radii * ball.positions[i]);
        out.normals.push_back(glm::normalize(ball.normals[i] / radii));
        out.colors.push_back(glm::vec4(color, 1));
    }
    for (const glm::uvec3& t : ball.triangles) out.triangles.push_back(t + first);
}

/// A bath duck; its waterline is y = 0, and it swims towards +x.
Primitive duck() {
    const glm::vec3 yellow(0.95f, 0.68f, 0.04f), orange(0.9f, 0.28f, 0.02f), black(0.02f);
    Primitive out;
    add_ellipsoid(out, {0, 0.07f, 0}, {0.25f, 0.16f, 0.19f}, yellow, 14);
    add_ellipsoid(out, {-0.22f, 0.17f, 0}, {0.1f, 0.07f, 0.09f}, yellow, 8);
    for (const float side : {-1.f, 1.f}) {
        add_ellipsoid(out, {-0.04f, 0.12f, side * 0.17f}, {0.15f, 0.08f, 0.05f}, yellow, 8);
        add_ellipsoid(out, {0.225f, 0.345f, side * 0.07f}, {0.018f, 0.026f, 0.02f}, black, 5);
    }
    add_ellipsoid(out, {0.14f, 0.31f, 0}, {0.125f, 0.125f, 0.12f}, yellow, 12);
    add_ellipsoid(out, {0.275f, 0.285f, 0}, {0.075f, 0.026f, 0.06f}, orange, 6);
    return out;
}

}  // namespace

Scene make_waves(uint64_t triangles) {
    const auto cells = uint32_t(std::sqrt(double(triangles) / 2));
    const std::string name = fmt::format("builtin:waves:{}", triangles);
    SceneBuilder build(name.c_str());
    add_pool(build);

    Water water;
    water.cells = cells;
    water.size = kPool;
    water.speed = 0.8f;
    water.damping = 0.22f;
    // Half of what is stable: c dt < dx / sqrt(2).
    water.steps_per_second = 120 * uint32_t(std::ceil(double(water.speed) * cells / (0.5 * kPool * 120)));
    const auto swims = [&](const char* what, Primitive shape, Material material, const Water::Float& f) {
        water.floats.push_back(f);
        water.floats.back().node = build.add(what, std::move(shape), build.material(std::move(material)));
    };
    Material ball = matte("red ball", {0.80f, 0.06f, 0.05f});
    ball.roughness = 0.25f;
    swims("ball", sphere({0, 0.07f, 0}, 0.22f, 12), ball, {-1, {-0.55f, 0.75f}, 0.25f, 14, 0.1f, 0.2f});
    Material ring = matte("orange ring", {0.95f, 0.45f, 0.05f});
    ring.roughness = 0.35f;
    swims("ring", torus({0, 0.02f, 0}, 0.3f, 0.09f, 48, 20), ring, {-1, {0.75f, 0.35f}, 0.3f, 19, 0.6f, 0.38f});
    swims("steel ball", sphere({0, 0.04f, 0}, 0.2f, 16), metal("steel", {0.9f, 0.91f, 0.92f}),
          {-1, {0.1f, -0.85f}, 0.45f, 16, 0.35f, 0.19f});
    Material rubber = matte("rubber", glm::vec3(1));
    rubber.roughness = 0.3f;
    swims("duck", duck(), rubber, {-1, {-1.05f, -0.6f}, 0.3f, 12, 0.9f, 0.22f});

    Material material;
    material.name = "water";
    material.roughness = 0;
    material.transmission = 1;
    material.ior = 1.33f;
    material.thickness = kDepth;
    material.attenuation_color = {0.35f, 0.72f, 0.76f};
    material.attenuation_distance = 1.6f;
    Primitive surface = sheet(cells);
    water.start = start_heights(surface);
    water.node = build.add("water", std::move(surface), build.material(material));
    build.camera({1.15f, 1.95f, 3.9f}, {0.05f, -0.12f, -0.1f}, 44);
    Scene scene = build.take();
    scene.notes.push_back(fmt::format("the water has {} triangles, the pool and what swims in it {}",
                                      2ull * cells * cells, flatten(scene).triangles.size() - 2ull * cells * cells));
    scene.generated.waters.push_back(std::move(water));
    scene.generated.animation = 0;
    scene.generated.reach = {{-kPool / 2 - 0.35f, -kDepth, -kPool / 2 - 0.35f},
                             {kPool / 2 + 0.35f, kRim + 1.7f, kPool / 2 + 0.35f}};
    scene.animations.push_back({"waves", INFINITY, {}});
    settle(scene);
    return scene;
}

}  // namespace peelray
