// EXT_lights_image_based: what is read of it, and what is refused.
#include <cmath>

#include "loaders/load.h"
#include "loaders/scene_files.h"

namespace peelray::testing {
namespace {

/// A TGA image of one colour, with alpha, top row first.
std::string tga(uint8_t size, uint32_t color, uint8_t height = 0) {
    const uint8_t rows = height ? height : size;
    std::string bytes(18, '\0');
    bytes[2] = 2;
    bytes[12] = char(size);
    bytes[14] = char(rows);
    bytes[16] = 32;
    bytes[17] = 0x28;
    for (int i = 0; i < size * rows; i++)
        bytes += {char(color >> 16 & 255), char(color >> 8 & 255), char(color & 255), char(color >> 24)};
    return bytes;
}

json lit_square(const TempFolder& folder) {
    json gltf = square();
    gltf["extensionsUsed"] = {"EXT_lights_image_based"};
    json light = {{"intensity", 2.5}, {"rotation", {0, 0.6, 0, 0.8}}, {"specularImageSize", 2}};
    for (int i = 0; i < 9; i++) light["irradianceCoefficients"].push_back({0.1 * i, 0.2, -0.3});
    light["specularImages"] = json::array({{0, 1, 2, 3, 4, 5}, {6, 6, 6, 6, 6, 6}});
    for (int face = 0; face < 7; face++) {
        const std::string name = "face" + std::to_string(face) + ".tga";
        folder.write(name, tga(face < 6 ? 2 : 1, 0xFF000080u + uint32_t(face) * 0x1000u));
        gltf["images"].push_back({{"uri", name}});
    }
    gltf["extensions"]["EXT_lights_image_based"]["lights"] = json::array({json{{"name", "unused"}}, light});
    gltf["scenes"][0]["extensions"]["EXT_lights_image_based"]["light"] = 1;
    return gltf;
}

json& light_of(json& gltf) {
    return gltf["extensions"]["EXT_lights_image_based"]["lights"][1];
}

TEST(GltfImageLight, IsRead) {
    const TempFolder folder;
    json gltf = lit_square(folder);
    folder.write("face2.tga", tga(2, 0x80FF8000u));  // twice as bright as its alpha says
    const Scene scene = load(folder, gltf);
    EXPECT_EQ(all_notes(scene), "");
    EXPECT_TRUE(scene.extensions_unsupported.empty());
    ASSERT_TRUE(scene.cube_light);
    const CubeLight& light = *scene.cube_light;
    EXPECT_EQ(light.size, 2u);
    EXPECT_EQ(light.intensity, 2.5f);
    const double half = std::pow((128 / 255.0 + 0.055) / 1.055, 2.4);  // IEC 61966-2-1
    expect_near(light.faces[0][3], glm::vec3(float(half), 0, 0));
    expect_near(light.faces[2][0], glm::vec3(0, float(half * 255 / 128), float(255 / 128.0)));
    EXPECT_GT(light.faces[5][0].y, light.faces[4][0].y);
    // By 2 acos(0.8) around +y: what shone from +z shines from between +z and +x.
    expect_near(glm::vec3(light.turn * glm::dvec3(0, 0, 1)), glm::vec3(0.96f, 0, 0.28f));
}

TEST(GltfImageLight, BelongsToAScene) {
    const TempFolder folder;
    json gltf = lit_square(folder);
    gltf["scenes"].push_back({{"nodes", {0}}});
    gltf["scene"] = 1;
    EXPECT_FALSE(load(folder, gltf).cube_light);
    gltf["scene"] = 0;
    EXPECT_TRUE(load(folder, gltf).cube_light);
    gltf["scenes"][0].erase("extensions");
    EXPECT_FALSE(load(folder, gltf).cube_light);
    gltf = lit_square(folder);
    gltf["extensionsRequired"] = {"EXT_lights_image_based"};
    EXPECT_TRUE(load(folder, gltf).cube_light);
    light_of(gltf).erase("intensity");
    light_of(gltf).erase("rotation");
    light_of(gltf)["specularImageSize"] = 256;
    const Scene scene = load(folder, gltf);
    EXPECT_EQ(scene.cube_light->intensity, 1);
    EXPECT_EQ(scene.cube_light->turn, glm::dmat3(1));
    EXPECT_TRUE(has_note(scene, "specularImageSize 256 is not that of its images, 2"));
}

TEST(GltfImageLight, WhatIsWrongIsSaid) {
    const TempFolder folder;
    const json good = lit_square(folder);
    const auto refused = [&](auto change, const std::string& what) {
        json gltf = good;
        change(gltf);
        const std::string line = error_of(folder, gltf);
        EXPECT_MENTIONS(line, "scene.gltf");
        EXPECT_MENTIONS(line, "EXT_lights_image_based");
        EXPECT_MENTIONS(line, what);
    };
    refused([](json& g) { g["scenes"][0]["extensions"]["EXT_lights_image_based"]["light"] = 2; },
            "light: 2 is out of range, the file has 2 image-based lights");
    refused([](json& g) { g["scenes"][0]["extensions"]["EXT_lights_image_based"]["light"] = "sun"; },
            "light: is string, must be a number");
    refused([](json& g) { g["scenes"][0]["extensions"]["EXT_lights_image_based"].clear(); }, "must be a number");
    refused([](json& g) { g.erase("extensions"); }, "the file has 0 image-based lights");
    for (const char* member : {"irradianceCoefficients", "specularImages", "specularImageSize"}) {
        refused([&](json& g) { light_of(g).erase(member); }, fmt::format("lights[1]: \"{}\" is missing", member));
        refused([&](json& g) { light_of(g)[member] = "x"; }, fmt::format("lights[1].{}: is string", member));
    }
    refused(
        [](json& g) {
            light_of(g)["irradianceCoefficients"].push_back({1, 2, 3});
        },
        "irradianceCoefficients: must be 9 triples of numbers, is 10");
    refused(
        [](json& g) {
            light_of(g)["irradianceCoefficients"][3] = {1, 2};
        },
        "irradianceCoefficients[3]: must be 3 numbers, is 2");
    refused([](json& g) { light_of(g)["specularImages"] = json::array(); }, "specularImages: is empty");
    refused(
        [](json& g) {
            light_of(g)["specularImages"][1] = {0, 1};
        },
        "specularImages[1]: must be 6 images, one for each face of a cube, is 2");
    refused([](json& g) { light_of(g)["specularImages"][0][4] = 7; },
            "specularImages[0][4]: 7 is out of range, the file has 7 images");
    refused([](json& g) { light_of(g)["specularImages"][0][4] = 1.5; }, "specularImages[0][4]: 1.5 is out of range");
    refused([](json& g) { light_of(g)["rotation"] = {0, 1, 0}; }, "rotation: must be 4 numbers, is 3");
    refused([](json& g) { light_of(g)["intensity"] = -1; }, "intensity: -1 is below 0");
    refused([](json& g) { light_of(g)["specularImages"][0][1] = 6; },
            "specularImages[0][1]: the image has 1x1 pixels, the faces of a cube are squares of one size, here of 2");
    folder.write("face0.tga", tga(2, 0xFF808080u, 3));
    refused([](json&) {}, "specularImages[0][0]: the image has 2x3 pixels");
    folder.write("face0.tga", "no image");
    refused([](json&) {}, "specularImages[0][0]: 8 bytes that are no PNG, JPEG or WebP image");
}

}  // namespace
}  // namespace peelray::testing
