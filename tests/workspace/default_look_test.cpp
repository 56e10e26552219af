// What a file looks like that says nothing about light and camera: the studio, and the view that it fills.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "image/temp_folder.h"
#include "scene/picture.h"
#include "workspace/posed_scene.h"

namespace peelray {
namespace {

using nlohmann::json;

class DefaultLook : public TempFolder {
  protected:
    void SetUp() override {
        TempFolder::SetUp();
        const float numbers[] = {-1, -1, 0, 1,  -1, 0, 1, 1, 0, -1, 1, 0,  // corners
                                 0,  2,                                    // times
                                 0,  0,  0, 10, 0,  0};                    // places
        put("numbers.bin", std::string(reinterpret_cast<const char*>(numbers), sizeof numbers));
    }

    /// Squares with corners at ±1 in the plane z = 0; `nodes` show them, mesh 1 with a mask that leaves nothing.
    json squares(const char* nodes) const {
        json gltf = json::parse(R"({"asset": {"version": "2.0"},
            "buffers": [{"uri": "numbers.bin", "byteLength": 80}],
            "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 8},
                            {"buffer": 0, "byteOffset": 56, "byteLength": 24}],
            "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
                          {"bufferView": 1, "componentType": 5126, "count": 2, "type": "SCALAR", "min": [0],
                           "max": [2]},
                          {"bufferView": 2, "componentType": 5126, "count": 2, "type": "VEC3"}],
            "materials": [{"alphaMode": "MASK", "pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 0.25]}}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "mode": 6}]},
                       {"primitives": [{"attributes": {"POSITION": 0}, "mode": 6, "material": 0}]}]})");
        gltf["nodes"] = json::parse(nodes);
        gltf["scenes"][0]["nodes"] = json::array();
        for (size_t i = 0; i < gltf["nodes"].size(); i++) gltf["scenes"][0]["nodes"].push_back(i);
        return gltf;
    }
    /// One of which the animation moves from 0 to 10 along x within two seconds; at rest it is elsewhere.
    json moving() const {
        json gltf = squares(R"([{"mesh": 0, "translation": [0, -20, 0]}])");
        gltf["animations"] = json::parse(R"([{"samplers": [{"input": 1, "output": 2}],
            "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}]}])");
        return gltf;
    }
    PictureArguments settings_of(const json& gltf) const {
        PictureArguments settings;
        settings.scene = put("scene.gltf", gltf.dump()).string();
        return settings;
    }
};

/// Shares of the picture's width and height: the least and the greatest of all triangles, from the left and the bottom.
Box extent_of(PosedScene& scene, const Camera& camera, float aspect, size_t triangles) {
    const View view = make_view(camera, aspect, scene.bounds().lower, scene.bounds().upper);
    Box box;
    for (size_t i = 0; i < triangles; i++)
        for (int k = 0; k < 3; k++) {
            const glm::vec3 p = scene.geometry().positions[scene.geometry().triangles[i][k]] - view.eye;
            const float depth = glm::dot(p, view.forward);
            EXPECT_GT(depth, 0);
            box.add(glm::vec3(0.5f + 0.5f * glm::dot(p, view.right) / glm::dot(view.right, view.right) / depth,
                              0.5f + 0.5f * glm::dot(p, view.up) / glm::dot(view.up, view.up) / depth, 0));
        }
    return box;
}

void expect_within_margins(const Box& extent) {
    EXPECT_GE(std::min(extent.lower.x, extent.lower.y), 0.05f - 1e-4f);
    EXPECT_LE(std::max(extent.upper.x, extent.upper.y), 0.95f + 1e-4f);
}

float fullest(const Box& extent) {
    return std::max(extent.upper.x - extent.lower.x, extent.upper.y - extent.lower.y);
}

constexpr float kAspect = 1.25f;  // of the default size

TEST_F(DefaultLook, AFileWithoutLightsStandsInTheStudio) {
    const std::vector<glm::vec4> studio = studio_environment().texels,
                                 sky = sky_environment(default_sun_direction()).texels;
    const json plain = squares(R"([{"mesh": 0}])");
    EXPECT_EQ(PosedScene(settings_of(plain)).environment().texels, studio);
    json glowing = plain;
    glowing["materials"][0]["emissiveFactor"] = {1, 1, 1};
    glowing["meshes"][0]["primitives"][0]["material"] = 0;
    EXPECT_EQ(PosedScene(settings_of(glowing)).environment().texels, studio) << "as viewers of glTF have it";
    PictureArguments obj;
    obj.scene = put("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").string();
    EXPECT_EQ(PosedScene(obj).environment().texels, studio);
    PictureArguments builtin;
    builtin.scene = "builtin:blob:500";
    EXPECT_EQ(PosedScene(builtin).environment().texels, sky) << "built-in scenes keep their look";
    // Whatever is said counts.
    obj.sky = true;
    EXPECT_EQ(PosedScene(obj).environment().texels, sky);
    obj.sky = false;
    obj.background = glm::vec3(3, 2, 1);
    EXPECT_EQ(glm::vec3(PosedScene(obj).environment().texels.front()), glm::vec3(3, 2, 1));
    json lit = squares(R"([{"mesh": 0}, {"extensions": {"KHR_lights_punctual": {"light": 0}}}])");
    lit["extensionsUsed"] = {"KHR_lights_punctual"};
    lit["extensions"] = json::parse(R"({"KHR_lights_punctual": {"lights": [{"type": "directional"}]}})");
    EXPECT_EQ(glm::vec3(PosedScene(settings_of(lit)).environment().texels.front()), glm::vec3(0.05f));
}

TEST_F(DefaultLook, WhatIsVisibleFillsThePicture) {
    const json plain = squares(R"([{"mesh": 0}])");
    PosedScene scene(settings_of(plain));
    const Box extent = extent_of(scene, scene.camera(), kAspect, 2);
    expect_within_margins(extent);
    EXPECT_NEAR(fullest(extent), 0.9, 1e-3);

    json more = squares(R"([{"mesh": 0}, {"mesh": 1, "translation": [30, 0, 0]},
        {"mesh": 0, "translation": [0, 50, 0], "extensions": {"KHR_node_visibility": {"visible": false}}}])");
    more["extensionsUsed"] = {"KHR_node_visibility"};
    PictureArguments settings = settings_of(more);
    settings.floor = true;
    PosedScene crowded(settings);
    EXPECT_EQ(crowded.camera().eye, scene.camera().eye) << "what cannot be seen does not count";
    EXPECT_EQ(crowded.camera().look, scene.camera().look);
    EXPECT_GT(crowded.bounds().upper.x, 30) << "the planes still hold everything";
    settings.material = MaterialOverride::clay;
    EXPECT_NE(PosedScene(settings).camera().eye, scene.camera().eye) << "clay has no holes";

    settings = settings_of(squares(R"([{"mesh": 1}])"));
    EXPECT_EQ(PosedScene(settings).camera().eye, scene.camera().eye) << "rather than nothing";
}

TEST_F(DefaultLook, TheLensThatIsChosenIsFilledToo) {
    PictureArguments settings = settings_of(squares(R"([{"mesh": 0, "scale": [1, 9, 1]}])"));
    for (const float degrees : {8.f, 75.f}) {
        settings.fov = degrees;
        settings.size = {300, 700};
        PosedScene scene(settings);
        const Box extent = extent_of(scene, scene.camera(), 300.f / 700, 2);
        expect_within_margins(extent);
        EXPECT_NEAR(fullest(extent), 0.9, 1e-3);
    }
}

TEST_F(DefaultLook, AnAnimationIsFramedByItsReach) {
    PictureArguments settings = settings_of(moving());
    settings.time = 0.5;
    PosedScene scene(settings);
    const Camera camera = scene.camera();
    EXPECT_GT(camera.look.y, -5) << "the rest pose is not shown";
    Box all;
    for (int i = 0; i <= 8; i++) {
        scene.move_to(i / 4.0);
        EXPECT_EQ(scene.camera().eye, camera.eye);
        const Box extent = extent_of(scene, camera, kAspect, 2);
        all.add(extent.lower);
        all.add(extent.upper);
    }
    expect_within_margins(all);
    EXPECT_NEAR(fullest(all), 0.9, 1e-3);
    // Every moment has this view by itself, too.
    for (const double time : {0.0, 1.9}) {
        settings.time = time;
        EXPECT_EQ(PosedScene(settings).camera().eye, camera.eye);
    }
    settings.time.reset();
    EXPECT_LT(PosedScene(settings).camera().look.y, -15) << "without a moment it is at rest";
}

TEST_F(DefaultLook, AMomentCanBeFramedByItself) {
    PictureArguments settings = settings_of(moving());
    settings.time = 0.5;
    const Camera reach = PosedScene(settings).camera();
    settings.frame_moment = true;
    PosedScene scene(settings);
    EXPECT_NE(scene.camera().eye, reach.eye);
    for (const double time : {0.5, 1.5}) {
        scene.move_to(time);
        const Box extent = extent_of(scene, scene.camera(), kAspect, 2);
        expect_within_margins(extent);
        EXPECT_NEAR(fullest(extent), 0.9, 1e-3);
    }
    settings.floor = true;
    settings.time = 1.5;
    EXPECT_EQ(PosedScene(settings).camera().eye, scene.camera().eye) << "the floor does not count";
}

TEST_F(DefaultLook, ATurntableSeesEverythingOnTheWayRound) {
    PictureArguments settings = settings_of(squares(R"([{"mesh": 0, "scale": [9, 1, 1], "translation": [4, 0, 7]}])"));
    settings.goes_round = true;
    PosedScene scene(settings);
    Box all;
    for (int i = 0; i < 72; i++) {
        const Box extent = extent_of(scene, turned(scene.camera(), i / 72.0), kAspect, 2);
        all.add(extent.lower);
        all.add(extent.upper);
    }
    expect_within_margins(all);
    EXPECT_NEAR(fullest(all), 0.9, 0.01);
}

}  // namespace
}  // namespace peelray
