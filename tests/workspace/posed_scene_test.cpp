// Scenes as settings open them, without a device.
#include "workspace/posed_scene.h"

#include <fmt/core.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "base/error.h"

namespace peelray {
namespace {

PictureArguments settings_of_scene(const char* name) {
    PictureArguments settings;
    settings.scene = name;
    return settings;
}

TEST(PosedScene, StandsAtRestUnlessAMomentIsAskedFor) {
    PictureArguments settings = settings_of_scene("builtin:walker");
    PosedScene still(settings);
    EXPECT_TRUE(still.animation().empty());
    EXPECT_EQ(still.time(), std::nullopt);
    EXPECT_EQ(still.geometry().positions, flatten(still.scene()).positions);
    still.move_to(0.5);
    EXPECT_EQ(still.time(), std::nullopt) << "there is nothing to move";
    settings.time = 0.5;
    PosedScene posed(settings);
    EXPECT_EQ(posed.animation(), "0");
    EXPECT_EQ(posed.time(), 0.5);
    EXPECT_NE(posed.geometry().positions, still.geometry().positions);
}

TEST(PosedScene, AMomentIsTheSameWhereverItComesFrom) {
    for (const char* name :
         {"builtin:walker", "builtin:blob:500", "builtin:waves:200", "builtin:particles:50", "builtin:cloth:50"}) {
        SCOPED_TRACE(name);
        PictureArguments settings = settings_of_scene(name);
        settings.time = 0.8;
        PosedScene direct(settings);
        settings.time = 0;
        PosedScene moved(settings);
        const std::vector<glm::vec3> start = moved.geometry().positions;
        for (const double time : {0.3, 1.4, 0.8}) {
            moved.move_to(time);
            moved.geometry();
        }
        EXPECT_EQ(moved.geometry().positions, direct.geometry().positions);
        EXPECT_NE(moved.geometry().positions, start);
        EXPECT_EQ(moved.bounds().lower, direct.bounds().lower) << "what frames the picture does not wobble";
        EXPECT_EQ(moved.bounds().upper, direct.bounds().upper);
        EXPECT_EQ(moved.camera().eye, direct.camera().eye);
        // Where a picture's moment lies does not shape the bodies.
        const Assembly a = moved.assembly(), b = direct.assembly();
        EXPECT_EQ(a.positions, b.positions);
        EXPECT_EQ(a.instances.size(), b.instances.size());
    }
}

TEST(PosedScene, TheFloorIsTheLastOfTheScene) {
    PictureArguments settings = settings_of_scene("builtin:blob:500");
    const uint64_t without = PosedScene(settings).triangles();
    settings.floor = true;
    PosedScene scene(settings);
    EXPECT_EQ(scene.triangles(), without + 2);
    EXPECT_EQ(scene.scene().nodes.back().name, "floor");
    EXPECT_LT(scene.bounds().lower.y, scene.framed().lower.y);
    EXPECT_GT(scene.bounds().upper.x, scene.framed().upper.x);
}

TEST(PosedScene, OneMaterialForAll) {
    PictureArguments settings = settings_of_scene("builtin:teapots");
    settings.material = MaterialOverride::glass;
    settings.floor = true;
    const PosedScene opened(settings);
    const std::vector<Material>& materials = opened.scene().materials;
    ASSERT_GT(materials.size(), 1u);
    for (size_t i = 0; i + 1 < materials.size(); i++) EXPECT_EQ(materials[i].transmission, 1);
    EXPECT_EQ(materials.back().transmission, 0) << "the floor comes afterwards";
}

TEST(PosedScene, CamerasBySettings) {
    PictureArguments settings = settings_of_scene("builtin:glass");
    const Camera own = PosedScene(settings).camera();
    settings.eye = glm::vec3(1, 2, 3);
    settings.fov = 90;
    const PosedScene placed(settings);
    EXPECT_EQ(placed.camera().eye, glm::dvec3(1, 2, 3));
    EXPECT_EQ(placed.camera().look, glm::dvec3(0.5f * (placed.framed().lower + placed.framed().upper)));
    EXPECT_NE(placed.camera().vertical_fov, own.vertical_fov);
    settings.camera = "nobody";
    try {
        PosedScene refused(settings);
        FAIL() << "there is no such camera";
    } catch (const Error& error) {
        EXPECT_EQ(error.settings(), std::vector<std::string>{"camera"}) << error.what();
    }
}

TEST(PosedScene, NotesGoToWhoeverListens) {
    PictureArguments settings = settings_of_scene("builtin:glass");
    settings.time = 1;
    std::vector<std::string> notes;
    testing::internal::CaptureStderr();
    testing::internal::CaptureStdout();
    PosedScene heard(settings, [&](const std::string& text) { notes.push_back(text); });
    PosedScene unheard(settings);
    EXPECT_EQ(testing::internal::GetCapturedStderr() + testing::internal::GetCapturedStdout(), "");
    EXPECT_NE(std::find(notes.begin(), notes.end(), "the scene has no animation: everything stands at rest"),
              notes.end());
}

/// A triangle in a cube of light of its own: red from +x, elsewhere black.
std::string scene_in_red_light(const std::filesystem::path& folder) {
    const auto write = [&](const char* name, const std::string& bytes) {
        std::ofstream(folder / name, std::ios::binary) << bytes;
    };
    std::string header(18, '\0');  // TGA, one texel of 24 bits
    header[2] = 2;
    header[12] = header[14] = 1;
    header[16] = 24;
    write("red.tga", header + std::string("\0\0\xff", 3));
    write("black.tga", header + std::string(3, '\0'));
    const float corners[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    write("corners.bin", std::string(reinterpret_cast<const char*>(corners), sizeof corners));
    write("lit.gltf", R"({"asset": {"version": "2.0"}, "extensionsUsed": ["EXT_lights_image_based"],
        "scenes": [{"nodes": [0], "extensions": {"EXT_lights_image_based": {"light": 0}}}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "buffers": [{"byteLength": 36, "uri": "corners.bin"}], "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3}],
        "images": [{"uri": "red.tga"}, {"uri": "black.tga"}],
        "extensions": {"EXT_lights_image_based": {"lights": [{"intensity": 2, "specularImageSize": 1,
            "irradianceCoefficients": [[0,0,0],[0,0,0],[0,0,0],[0,0,0],[0,0,0],[0,0,0],[0,0,0],[0,0,0],[0,0,0]],
            "specularImages": [[0, 1, 1, 1, 1, 1]]}]}}})");
    return (folder / "lit.gltf").string();
}

TEST(PosedScene, StandsInTheLightOfItsFile) {
    const std::filesystem::path folder =
        std::filesystem::temp_directory_path() / fmt::format("peelray_posed_{}", getpid());
    std::filesystem::create_directories(folder);
    const std::string file = scene_in_red_light(folder);
    PictureArguments settings = settings_of_scene(file.c_str());
    // What comes from a direction in the horizontal plane.
    const auto red_from = [&](float u) {
        const PosedScene posed(settings);
        const Environment& e = posed.environment();
        return e.texels[size_t(e.height / 2) * e.width + size_t(u * float(e.width))].x;
    };
    EXPECT_NEAR(red_from(0.75f), 2, 0.15) << "+x, a little beside the middle of its only texel";
    EXPECT_EQ(red_from(0.25f), 0) << "-x";
    EXPECT_EQ(PosedScene(settings).env_mode(), EnvironmentMode::sampled) << "it is an image";
    settings.env_rotation = 90;
    settings.env_intensity = 3;
    EXPECT_NEAR(red_from(0.5f), 6, 0.45) << "turned to -z";
    EXPECT_EQ(red_from(0.75f), 0);
    settings.env_mode = EnvironmentMode::filtered;
    EXPECT_FALSE(PosedScene(settings).environment().filtered.texels.empty());
    settings = settings_of_scene(file.c_str());
    settings.sky = true;
    EXPECT_FALSE(PosedScene(settings).environment().is_image);
    settings.sky = false;
    settings.background = Background{glm::vec3(0.25f)};
    EXPECT_EQ(PosedScene(settings).environment().texels[0].z, 0.25f);
    std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace peelray
