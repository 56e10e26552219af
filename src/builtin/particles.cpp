// A fountain of small bodies over a mirroring floor.
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "base/error.h"
#include "builtin/shapes.h"
#include "motion/simulation.h"

namespace peelray {
namespace {

/// A cut stone: flat-shaded, of radius 1.
Primitive gem() {
    Primitive out;
    const glm::vec3 top(0, 0.75f, 0), bottom(0, -1, 0);
    const auto ring = [](int i, int n, float radius, float y) {
        const float angle = 6.2831853f * float(i) / float(n);
        return glm::vec3(radius * std::cos(angle), y, radius * std::sin(angle));
    };
    const auto add = [&](const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
        const auto first = uint32_t(out.positions.size());
        out.positions.insert(out.positions.end(), {a, b, c});
        out.normals.insert(out.normals.end(), 3, glm::normalize(glm::cross(b - a, c - a)));
        out.triangles.push_back({first, first + 1, first + 2});
    };
    constexpr int n = 8;
    for (int i = 0; i < n; i++) {
        const glm::vec3 a = ring(i, n, 0.55f, 0.75f), b = ring(i + 1, n, 0.55f, 0.75f), c = ring(i, n, 1, 0.2f),
                        d = ring(i + 1, n, 1, 0.2f);
        add(top, b, a);
        add(a, b, d);
        add(a, d, c);
        add(c, d, bottom);
    }
    out.flat = true;
    return out;
}

}  // namespace

Scene make_particles(uint64_t count) {
    const std::string name = fmt::format("builtin:particles:{}", count);
    SceneBuilder build(name.c_str());
    Material floor = metal("floor", glm::vec3(0.42f, 0.44f, 0.5f));
    floor.metallic = 0.6f;
    floor.base_color_texture = build.tiles(2, 0xE0E0E0, 0xB0B0B0, true);
    build.add("floor", parallelogram({-5, 0, 5}, {10, 0, 0}, {0, 0, -10}, 5), build.material(floor));
    build.add("fountain", sphere({0, 0.3f, 0}, 0.3f, 24), build.material(metal("chrome", {0.93f, 0.94f, 0.95f})));
    build.add("glass ball", sphere({-0.95f, 0.36f, 1.35f}, 0.36f, 24),
              build.material(glass("glass", {0.8f, 0.93f, 0.96f}, 1, 0.8f)));
    build.add(
        "mirror", box({1.0f, 0, -0.03f}, {2.6f, 1.7f, 0.03f}), build.material(metal("mirror", glm::vec3(0.95f))),
        glm::rotate(glm::translate(glm::mat4(1), {-0.3f, 0.005f, -1.9f}), glm::radians(-12.f), glm::vec3(0, 1, 0)));

    // Four kinds, in turns.
    const glm::mat4 nowhere(1);
    Material red = matte("red", {0.78f, 0.05f, 0.07f}), emerald = matte("emerald", {0.03f, 0.5f, 0.2f});
    red.roughness = emerald.roughness = 0.2f;
    const std::string names[] = {"pearl", "gem", "ring", "cube"};
    Primitive shapes[] = {sphere({0, 0, 0}, 1, 5), gem(), torus({0, 0, 0}, 0.72f, 0.28f, 18, 9),
                          box(glm::vec3(-0.62f), glm::vec3(0.62f))};
    const uint32_t materials[] = {build.material(metal("gold", {1.0f, 0.78f, 0.34f})), build.material(emerald),
                                  build.material(metal("silver", {0.93f, 0.93f, 0.92f})), build.material(red)};
    Swarm swarm;
    swarm.period = 6;
    int meshes[4];
    for (uint64_t i = 0; i < count; i++) {
        const size_t kind = i % 4;
        const std::string body = fmt::format("{} {}", names[kind], i / 4);
        if (i < 4) {
            swarm.nodes.push_back(build.add(body.c_str(), std::move(shapes[kind]), materials[kind], nowhere));
            meshes[kind] = build.mesh_of(swarm.nodes.back());
        } else {
            swarm.nodes.push_back(build.again(body.c_str(), meshes[kind], nowhere));
        }
    }
    build.camera({1.3f, 1.55f, 5.6f}, {0.05f, 0.6f, 0}, 32);
    Scene scene = build.take();
    scene.generated.swarms.push_back(std::move(swarm));
    scene.generated.animation = 0;
    scene.generated.reach = {{-6, -0.1f, -6}, {6, 3, 6}};
    scene.animations.push_back({"fountain", 6, {}});
    settle(scene);
    return scene;
}

}  // namespace peelray
