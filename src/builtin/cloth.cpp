// A sheet that hangs over a ball which turns to and fro, in wind, over a floor that mirrors a little.

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "base/error.h"
#include "builtin/shapes.h"
#include "builtin/solids.h"
#include "motion/simulation.h"

namespace peelray {
namespace {

/// Two colours of yarn that cross: broad stripes both ways, thin ones beside them.
Texture tartan() {
    Texture texture;
    texture.name = "tartan";
    texture.width = texture.height = 256;
    const glm::vec3 red(0.62f, 0.045f, 0.05f), blue(0.035f, 0.07f, 0.22f), cream(0.93f, 0.86f, 0.70f);
    const auto yarn = [&](uint32_t i) {
        if (i % 128 >= 96) return blue;
        return i % 128 >= 46 && i % 128 < 50 ? cream : red;
    };
    for (uint32_t y = 0; y < texture.height; y++)
        for (uint32_t x = 0; x < texture.width; x++) {
            // Twill: which of both lies above goes along diagonals.
            const glm::vec3 color = glm::mix(yarn(x), yarn(y), (x + y) / 2 % 2 ? 0.62f : 0.38f);
            const auto channel = [](float value) {
                return uint32_t(std::lround(255 * std::pow(std::clamp(value, 0.f, 1.f), 1 / 2.2f)));
            };
            texture.texels.push_back(0xFF000000u | channel(color.z) << 16 | channel(color.y) << 8 | channel(color.x));
        }
    return texture;
}

/// Its vertices come from the simulation.
Primitive sheet(uint32_t across, uint32_t along) {
    Primitive out;
    const uint32_t row = across + 1;
    for (uint32_t z = 0; z <= along; z++)
        for (uint32_t x = 0; x <= across; x++) {
            out.positions.emplace_back(0);
            out.normals.emplace_back(0, 1, 0);
            out.uvs.emplace_back(4 * float(x) / float(across), 4 * float(z) / float(along));
        }
    for (uint32_t z = 0; z < along; z++)
        for (uint32_t x = 0; x < across; x++) {
            const uint32_t a = z * row + x, b = a + row;
            // Diagonals by turns, so that the mesh has no grain.
            if ((x + z) % 2) {
                out.triangles.push_back({a, b, b + 1});
                out.triangles.push_back({a, b + 1, a + 1});
            } else {
                out.triangles.push_back({a, b, a + 1});
                out.triangles.push_back({a + 1, b, b + 1});
            }
        }
    return out;
}

}  // namespace

Scene make_cloth(uint64_t triangles) {
    const std::string name = fmt::format("builtin:cloth:{}", triangles);
    SceneBuilder build(name.c_str());
    Cloth cloth;
    cloth.across = uint32_t(std::lround(std::sqrt(double(triangles) / 2)));
    cloth.along = uint32_t(std::lround(double(triangles) / 2 / cloth.across));
    cloth.points = 44;
    cloth.size = 1.9f;
    cloth.ball = {0, 0.78f, 0};
    cloth.radius = 0.42f;
    ClothSimulation hanging(cloth);
    hanging.settle();
    for (const glm::dvec3& p : hanging.net_at(0)) cloth.start.emplace_back(p);

    Material floor = matte("floor", glm::vec3(1));
    floor.roughness = 0;
    floor.base_color_texture = build.tiles(2, 0x9AA4AC, 0x86929C, true);
    build.add("floor", parallelogram({-5, 0, 5}, {10, 0, 0}, {0, 0, -10}, 8), build.material(floor));
    build.add("ball", sphere(cloth.ball, cloth.radius, 48), build.material(metal("chrome", {0.92f, 0.93f, 0.95f})));
    build.add("stand",
              finished(lathe(std::vector<glm::vec2>{{0, 0.003f},
                                                    {0.24f, 0.003f},
                                                    {0.25f, 0.01f},
                                                    {0.25f, 0.022f},
                                                    {0.24f, 0.03f},
                                                    {0.06f, 0.045f},
                                                    {0.035f, 0.08f},
                                                    {0.03f, 0.36f},
                                                    {0, 0.37f}},
                             72)),
              build.material(metal("brass", {0.88f, 0.70f, 0.38f})));
    const auto ball = [&](const char* what, const glm::vec3& color, const glm::vec3& at, float radius) {
        Material material = matte(what, color);
        material.roughness = 0.2f;
        build.add(what, sphere(at + glm::vec3(0, radius + 0.002f, 0), radius, 20), build.material(material));
    };
    ball("yellow ball", {0.88f, 0.60f, 0.05f}, {-1.15f, 0, -0.35f}, 0.17f);
    ball("blue ball", {0.05f, 0.16f, 0.55f}, {1.0f, 0, -1.05f}, 0.24f);
    ball("green ball", {0.06f, 0.40f, 0.14f}, {0.66f, 0, 1.02f}, 0.11f);
    Material wool = matte("wool", glm::vec3(1));
    wool.base_color_texture = build.texture(tartan());
    wool.sheen_color = glm::vec3(0.16f, 0.13f, 0.12f);
    wool.sheen_roughness = 0.5f;
    cloth.node = build.add("sheet", sheet(cloth.across, cloth.along), build.material(wool));
    build.camera({1.4f, 1.35f, 3.3f}, {0.02f, 0.56f, 0}, 31);
    Scene scene = build.take();
    scene.notes.push_back(fmt::format("the sheet has {} triangles, the rest {}", 2ull * cloth.across * cloth.along,
                                      flatten(scene).triangles.size() - 2ull * cloth.across * cloth.along));
    scene.generated.cloths.push_back(std::move(cloth));
    scene.generated.animation = 0;
    scene.generated.reach = {{-1.5f, 0, -1.5f}, {1.5f, 1.3f, 1.5f}};
    scene.animations.push_back({"wind", INFINITY, {}});
    settle(scene);
    return scene;
}

}  // namespace peelray
