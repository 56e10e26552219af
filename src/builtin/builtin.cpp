#include <algorithm>
#include <charconv>
#include <glm/gtc/matrix_transform.hpp>

#include "base/error.h"
#include "base/text.h"
#include "builtin/builtin.h"
#include "builtin/shapes.h"
#include "loaders/files.h"

namespace peelray {

std::vector<BuiltinScene> builtin_scenes() {
    return {{"teapots", "two mirroring Newell teapots on a polished checkered floor"},
            {"glass", "a glass sphere, torus and block one behind the other, and a mirror"},
            {"tree", "a tree with tens of thousands of leaves, for shadows"},
            {"leaves", "two trees whose leaves are cut out of squares by alpha masks, on a mirroring floor"},
            {"room", "a closed room with lamps, a mirror, glass and a teapot on a table"},
            {"walker", "a figure that walks over a mirror, behind and in front of glass"},
            {"desk", "a pocket watch with its movement on a desk in a room: from metres to tenths of a millimetre"},
            {"kitchen", "finely shaped things apart on a table; kitchen:N for N triangles (8 to 10000000)"},
            {"bricks", "a duck of toy bricks, as CAD exports them; bricks:N for N triangles (8 to 10000000)"},
            {"cloth", "a sheet over a ball in wind; cloth:N for some N triangles of the sheet (8 to 10000000)"},
            {"blob:N", "a displaced metal sphere of N triangles (8 to 10000000) over a floor"},
            {"waves", "a pool with swimming things; waves:N for some N triangles of water (8 to 10000000)"},
            {"particles", "a fountain of small bodies over a mirror; particles:N for N of them (8 to 1000000)"}};
}

namespace {

/// The N of builtin:NAME:N.
uint64_t parse_count(const char* name, std::string_view digits, uint64_t most) {
    uint64_t count = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), count);
    if (error != std::errc() || end != digits.data() + digits.size() || count < 8 || count > most)
        fail("builtin:{}:{}: N must be a whole number from 8 to {}, as in builtin:{}:120000", name,
             printable(digits, 40), most, name);
    return count;
}

}  // namespace

Scene make_builtin(std::string_view name) {
    if (name == "teapots") return make_teapots();
    if (name == "glass") return make_glass();
    if (name == "tree") return make_tree();
    if (name == "leaves") return make_leaves();
    if (name == "room") return make_room();
    if (name == "walker") return make_walker();
    if (name == "desk") return make_desk();
    if (name == "waves") return make_waves(32'768);
    if (name == "particles") return make_particles(3'000);
    if (name == "cloth") return make_cloth(32'768);
    if (name == "bricks") return make_bricks(200'000);
    if (name == "kitchen") return make_kitchen(200'000);
    if (name == "blob" || name.starts_with("blob:"))
        return make_blob(parse_count("blob", name.substr(std::min<size_t>(name.size(), 5)), 10'000'000));
    if (name.starts_with("waves:")) return make_waves(parse_count("waves", name.substr(6), 10'000'000));
    if (name.starts_with("particles:")) return make_particles(parse_count("particles", name.substr(10), 1'000'000));
    if (name.starts_with("kitchen:")) return make_kitchen(parse_count("kitchen", name.substr(8), 10'000'000));
    if (name.starts_with("cloth:")) return make_cloth(parse_count("cloth", name.substr(6), 10'000'000));
    if (name.starts_with("bricks:")) return make_bricks(parse_count("bricks", name.substr(7), 10'000'000));
    std::string known;
    for (const BuiltinScene& scene : builtin_scenes())
        known += fmt::format("{}{}", known.empty() ? "" : ", ", scene.name);
    fail("builtin:{}: no such built-in scene; known are {}", printable(name, 40), known);
}

Scene make_teapots() {
    SceneBuilder build("builtin:teapots");
    Material floor = metal("polished tiles", glm::vec3(1));
    floor.metallic = 0.75f;
    floor.base_color_texture = build.tiles(2, 0xD8DEE2, 0x4A4038, true);
    build.add("floor", parallelogram({-8, 0, 8}, {16, 0, 0}, {0, 0, -16}, 8), build.material(floor));

    // A hair above the floor: the teapot's bottom would otherwise touch it and fight for the same depth.
    const auto place = [](const glm::vec3& at, float degrees, float scale) {
        const glm::mat4 moved = glm::translate(glm::mat4(1), at + glm::vec3(0, 0.004f, 0));
        return glm::scale(glm::rotate(moved, glm::radians(degrees), glm::vec3(0, 1, 0)), glm::vec3(scale));
    };
    build.add("chrome teapot", teapot(16), build.material(metal("chrome", {0.92f, 0.93f, 0.95f})),
              place({-1.25f, 0, 0.25f}, 28, 0.5f));
    build.add("copper teapot", teapot(16), build.material(metal("copper", {0.95f, 0.64f, 0.43f})),
              place({1.55f, 0, -0.75f}, 205, 0.5f));

    const auto ball = [&](const char* name, const glm::vec3& color, const glm::vec3& at, float radius) {
        build.add(name, sphere(at + glm::vec3(0, radius, 0), radius, 16), build.material(matte(name, color)));
    };
    ball("red ball", {0.80f, 0.07f, 0.05f}, {0.15f, 0, 1.55f}, 0.33f);
    ball("blue ball", {0.06f, 0.16f, 0.70f}, {-2.75f, 0, -1.1f}, 0.55f);
    ball("yellow ball", {0.90f, 0.62f, 0.06f}, {2.75f, 0, 1.05f}, 0.38f);
    ball("green ball", {0.10f, 0.52f, 0.14f}, {0.1f, 0, -2.2f}, 0.6f);
    ball("white ball", {0.85f, 0.85f, 0.82f}, {-0.75f, 0, 1.95f}, 0.2f);
    build.add("teal torus", torus({1.25f, 0.16f, 1.45f}, 0.42f, 0.16f, 64, 32),
              build.material(matte("teal", {0.03f, 0.48f, 0.46f})));
    build.add("orange torus", torus({0, 0, 0}, 0.5f, 0.17f, 64, 32),
              build.material(matte("orange", {0.88f, 0.30f, 0.05f})),
              glm::rotate(glm::translate(glm::mat4(1), {-3.05f, 0.67f, 1.15f}), glm::radians(78.f),
                          glm::vec3(0.8f, 0, 0.6f)));
    build.camera({0.55f, 2.75f, 8.0f}, {-0.02f, 0.52f, 0.0f}, 36);
    return build.take();
}

Scene make_glass() {
    SceneBuilder build("builtin:glass");
    Material floor = matte("floor", glm::vec3(1));
    floor.roughness = 0.5f;
    floor.base_color_texture = build.tiles(2, 0xC8D0D4, 0x7A7068, true);
    build.add("floor", parallelogram({-6, 0, 6}, {12, 0, 0}, {0, 0, -9}, 6), build.material(floor));
    Material wall = matte("striped wall", glm::vec3(1));
    wall.base_color_texture = build.tiles(2, 0x3C5CC8, 0xDCE8F0, false);
    build.add("wall", parallelogram({-6, 0, -3}, {12, 0, 0}, {0, 5, 0}, 8), build.material(wall));

    const auto of_glass = [&](const char* name, const glm::vec3& tint, float thickness) {
        return build.material(glass(name, tint, thickness, 1.5f));
    };
    build.add("glass sphere", sphere({-0.55f, 0.85f, 1.3f}, 0.8f, 40),
              of_glass("green glass", {0.70f, 0.95f, 0.80f}, 1.6f));
    build.add(
        "glass torus", torus({0, 0, 0}, 0.75f, 0.27f, 128, 64), of_glass("blue glass", {0.62f, 0.80f, 0.97f}, 0.54f),
        glm::rotate(glm::translate(glm::mat4(1), {0.15f, 1.1f, -0.5f}), glm::radians(72.f), glm::vec3(1, 0.15f, 0)));
    build.add("glass block", box({-0.35f, -0.6f, -0.35f}, {0.35f, 0.6f, 0.35f}),
              of_glass("clear glass", {0.85f, 0.97f, 0.93f}, 0.7f),
              glm::rotate(glm::translate(glm::mat4(1), {1.35f, 0.61f, 0.95f}), glm::radians(32.f), glm::vec3(0, 1, 0)));
    build.add(
        "mirror", box({-1.0f, 0, -0.04f}, {1.0f, 2.3f, 0.04f}), build.material(metal("mirror", glm::vec3(0.95f))),
        glm::rotate(glm::translate(glm::mat4(1), {2.15f, 0.01f, -1.45f}), glm::radians(-30.f), glm::vec3(0, 1, 0)));
    build.add("red ball", sphere({-2.1f, 0.5f, -1.2f}, 0.5f, 16), build.material(matte("red", {0.78f, 0.06f, 0.05f})));
    build.add("yellow ball", sphere({0.75f, 0.28f, 2.2f}, 0.28f, 16),
              build.material(matte("yellow", {0.88f, 0.65f, 0.08f})));
    build.camera({0.25f, 1.85f, 6.9f}, {0.3f, 0.85f, 0.0f}, 34);
    return build.take();
}

}  // namespace peelray
