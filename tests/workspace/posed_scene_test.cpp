// Scenes as settings open them, without a device.
#include "workspace/posed_scene.h"

#include <gtest/gtest.h>

#include <algorithm>

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
    for (const char* name : {"builtin:walker", "builtin:blob:500", "builtin:waves:200", "builtin:particles:50"}) {
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

}  // namespace
}  // namespace peelray
