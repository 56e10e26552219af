// An interior: a closed room with lamps, whose walls every ray hits.

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "builtin/shapes.h"

namespace peelray {
namespace {

constexpr float half_width = 2.6f, height = 2.6f, front = 3.2f, back = -2.4f;

Light lamp(const char* name, const glm::vec3& at, float candela) {
    Light light;
    light.name = name;
    light.kind = Light::Kind::point;
    light.color = candela * glm::vec3(1.0f, 0.92f, 0.80f);
    light.position = at;
    return light;
}

void add_walls(SceneBuilder& build) {
    Material boards = matte("floor boards", glm::vec3(1));
    boards.roughness = 0.04f;
    boards.base_color_texture = build.tiles(2, 0x4A6E98, 0x3E5F86, false);
    const float width = 2 * half_width, depth = front - back;
    build.add("floor", parallelogram({-half_width, 0, front}, {width, 0, 0}, {0, 0, -depth}, 6),
              build.material(boards));
    const uint32_t white = build.material(matte("white wall", {0.78f, 0.76f, 0.72f}));
    build.add("ceiling", parallelogram({-half_width, height, back}, {width, 0, 0}, {0, 0, depth}), white);
    build.add("back wall", parallelogram({-half_width, 0, back}, {width, 0, 0}, {0, height, 0}), white);
    build.add("front wall", parallelogram({half_width, 0, front}, {-width, 0, 0}, {0, height, 0}), white);
    build.add("left wall", parallelogram({-half_width, 0, front}, {0, 0, -depth}, {0, height, 0}),
              build.material(matte("terracotta wall", {0.62f, 0.26f, 0.16f})));
    build.add("right wall", parallelogram({half_width, 0, back}, {0, 0, depth}, {0, height, 0}),
              build.material(matte("green wall", {0.22f, 0.40f, 0.26f})));
}

void add_table(SceneBuilder& build, const glm::vec3& at) {
    const uint32_t wood = build.material(matte("wood", {0.36f, 0.20f, 0.10f}));
    build.add("table top", box({-0.8f, 0.70f, -0.5f}, {0.8f, 0.75f, 0.5f}), wood, glm::translate(glm::mat4(1), at));
    Primitive legs;
    for (const float x : {-0.7f, 0.7f})
        for (const float z : {-0.4f, 0.4f})
            add_tube(legs, at + glm::vec3(x, 0.001f, z), at + glm::vec3(x, 0.699f, z), 0.035f, 0.035f, 24);
    build.add("table legs", std::move(legs), wood);
}

}  // namespace

Scene make_room() {
    SceneBuilder build("builtin:room");
    add_walls(build);
    const glm::vec3 table(-0.55f, 0, -0.7f);
    add_table(build, table);
    const auto on_table = [&](float x, float z) { return table + glm::vec3(x, 0.753f, z); };
    build.add(
        "chrome teapot", teapot(16), build.material(metal("chrome", {0.92f, 0.93f, 0.95f})),
        glm::scale(glm::rotate(glm::translate(glm::mat4(1), on_table(-0.25f, 0)), 0.6f, {0, 1, 0}), glm::vec3(0.13f)));
    Material glass;
    glass.name = "glass";
    glass.roughness = 0;
    glass.transmission = 1;
    glass.thickness = 0.3f;
    build.add("glass ball", sphere(on_table(0.42f, 0.12f) + glm::vec3(0, 0.15f, 0), 0.15f, 24), build.material(glass));
    build.add("mirror", box({-0.75f, 0.7f, back + 0.002f}, {1.55f, 2.1f, back + 0.04f}),
              build.material(metal("mirror", glm::vec3(0.95f))));
    build.add("brass ball", sphere({1.35f, 0.402f, 0.35f}, 0.4f, 32),
              build.material(metal("brass", {0.88f, 0.70f, 0.36f})));
    build.add("blue ring", torus({1.75f, 0.122f, -1.3f}, 0.42f, 0.12f, 96, 48),
              build.material(matte("blue", {0.08f, 0.17f, 0.58f})));
    build.add("white ball", sphere({-1.75f, 0.302f, 0.9f}, 0.3f, 24),
              build.material(matte("white", {0.8f, 0.8f, 0.78f})));
    // Shades that hide nothing: the lamps hang below them.
    const uint32_t shade = build.material(matte("lamp shade", {0.85f, 0.8f, 0.7f}));
    for (const glm::vec3& at : {glm::vec3(-0.55f, 2.0f, -0.7f), glm::vec3(1.3f, 2.2f, 1.2f)}) {
        Primitive cone;
        add_tube(cone, at + glm::vec3(0, 0.02f, 0), at + glm::vec3(0, 0.2f, 0), 0.22f, 0.05f, 48);
        build.add("lamp shade", std::move(cone), shade);
    }
    build.light(lamp("lamp over the table", {-0.55f, 1.98f, -0.7f}, 9));
    build.light(lamp("lamp at the front", {1.3f, 2.18f, 1.2f}, 7));
    build.camera({1.35f, 1.55f, 3.0f}, {-0.25f, 0.85f, -0.9f}, 52);
    return build.take();
}

}  // namespace peelray
