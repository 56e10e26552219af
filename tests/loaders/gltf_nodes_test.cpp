// Nodes of correct glTF files: hierarchies, instances, cameras, lights, and what moves them.
#include <cmath>
#include <functional>

#include "loaders/scene_files.h"
#include "motion/animation.h"

namespace peelray::testing {
namespace {

constexpr float pi = 3.14159265f;

TEST(GltfNodes, HierarchyIsDepthFirstAndTransforms) {
    const TempFolder folder;
    json gltf = square();
    gltf["nodes"] = {{{"mesh", 0}, {"translation", {0, 0, 1}}},
                     {{"children", {2, 0}}, {"scale", {2, 2, 2}}, {"rotation", {0, 0, std::sqrt(0.5), std::sqrt(0.5)}}},
                     {{"mesh", 0}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 10, 0, 0, 1}}}};
    gltf["scenes"][0]["nodes"] = {1};
    const Scene scene = load(folder, gltf);
    ASSERT_EQ(scene.nodes.size(), 3u);
    EXPECT_EQ(scene.nodes[0].source, 1);
    EXPECT_EQ(scene.nodes[1].source, 2);
    EXPECT_EQ(scene.nodes[2].source, 0);
    EXPECT_EQ(scene.nodes[2].parent, 0);
    const Geometry geometry = flatten(scene);
    ASSERT_EQ(geometry.triangles.size(), 4u);
    expect_near(geometry.positions[geometry.triangles[0].x], {0, 20, 0});  // x turned to y, then twice as far
    expect_near(geometry.positions[geometry.triangles[2].y], {0, 2, 2});
}

TEST(GltfNodes, InstancesOfANode) {
    const TempFolder folder;
    json gltf = square();
    const size_t translation = add_accessor(gltf, pack<float>({1, 2, 3, 4, 5, 6}), 5126, "VEC3", 2);
    const size_t rotation = add_accessor(gltf, pack<int8_t>({0, 0, 0, 127, 0, 0, 127, 0}), 5120, "VEC4", 2);
    gltf["accessors"][rotation]["normalized"] = true;
    const size_t scale = add_accessor(gltf, pack<float>({1, 1, 1, 2, 2, 2}), 5126, "VEC3", 2);
    gltf["extensionsUsed"] = gltf["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
    gltf["nodes"][0]["translation"] = {10, 0, 0};
    json& attributes = gltf["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
    attributes = {{"TRANSLATION", translation}, {"ROTATION", rotation}, {"SCALE", scale}, {"_ID", 0}};
    const Scene scene = load(folder, gltf);
    ASSERT_EQ(scene.nodes.size(), 3u);
    EXPECT_EQ(scene.nodes[0].mesh, -1);
    const Geometry g = flatten(scene);
    ASSERT_EQ(g.triangles.size(), 4u);
    expect_near(g.positions[g.triangles[0].y], glm::vec3(1, 2, 3) + glm::vec3(10, 0, 0) + glm::vec3(1, 0, 0));
    expect_near(g.positions[g.triangles[2].y], glm::vec3(4, 5, 6) + glm::vec3(10, 0, 0) + glm::vec3(-2, 0, 0));

    json bad = gltf;
    bad["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["SCALE"] = rotation;
    EXPECT_MENTIONS(error_of(folder, bad), "SCALE needs 3 numbers an instance");
    bad = gltf;
    bad["accessors"][scale]["count"] = 1;
    EXPECT_MENTIONS(error_of(folder, bad), "another attribute");
    bad = gltf;
    bad["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["SCALE"] = 99;
    EXPECT_MENTIONS(error_of(folder, bad), "99 is out of range");
    bad = gltf;
    bad["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"].erase("attributes");
    EXPECT_MENTIONS(error_of(folder, bad), "attributes");
}

TEST(GltfNodes, SceneChoice) {
    const TempFolder folder;
    json gltf = square();
    gltf["nodes"] = {{{"mesh", 0}, {"name", "a"}}, {{"mesh", 0}, {"name", "b"}}};
    gltf["scenes"] = {{{"nodes", {0}}}, {{"nodes", {1}}}};
    EXPECT_EQ(load(folder, gltf).nodes.at(0).name, "a");
    gltf["scene"] = 1;
    EXPECT_EQ(load(folder, gltf).nodes.at(0).name, "b");
    gltf.erase("scene");
    gltf.erase("scenes");
    EXPECT_EQ(load(folder, gltf).nodes.size(), 2u);
}

TEST(GltfNodes, DeepHierarchyNeedsNoCallStack) {
    const TempFolder folder;
    json gltf = square();
    constexpr int depth = 100000;
    for (int i = 0; i < depth; ++i) gltf["nodes"][i] = {{"children", {i + 1}}};
    gltf["nodes"][depth] = {{"mesh", 0}};
    EXPECT_EQ(load(folder, gltf).nodes.size(), depth + 1u);
}

TEST(GltfNodes, CamerasAndLights) {
    const TempFolder folder;
    json gltf = square();
    gltf["cameras"] = json::parse(R"([{"type": "perspective", "name": "p", "perspective": {"yfov": 0.5, "znear": 0.1}},
                                      {"type": "orthographic", "orthographic": {"xmag": 1, "ymag": 2, "zfar": 9, "znear": 0}}])");
    gltf["extensions"] = json::parse(
        R"({"KHR_lights_punctual": {"lights": [{"type": "spot", "intensity": 3, "color": [1, 0.5, 0], "range": 7,
        "spot": {"innerConeAngle": 0.1, "outerConeAngle": 0.2}}, {"type": "directional"}]}})");
    gltf["nodes"] = json::parse(
        R"([{"mesh": 0}, {"camera": 0, "translation": [0, 0, 5], "name": "front"}, {"camera": 1, "translation": [5, 0, 0]},
        {"translation": [1, 2, 3], "rotation": [-0.70710678, 0, 0, 0.70710678], "extensions": {"KHR_lights_punctual": {"light": 0}}},
        {"extensions": {"KHR_lights_punctual": {"light": 1}}}])");
    gltf["scenes"][0]["nodes"] = {0, 1, 2, 3, 4};
    const Scene scene = load(folder, gltf);
    ASSERT_EQ(scene.cameras.size(), 2u);
    expect_near(scene.cameras[0].eye, {0, 0, 5});
    expect_near(scene.cameras[0].look, {0, 0, 0});  // on its axis, next to the middle of the square
    expect_near(scene.cameras[0].up, {0, 1, 0});
    EXPECT_EQ(scene.cameras[0].name, "p");
    EXPECT_FLOAT_EQ(scene.cameras[0].vertical_fov, 0.5f);
    EXPECT_FLOAT_EQ(scene.cameras[1].orthographic_height, 4);
    ASSERT_EQ(scene.lights.size(), 2u);
    EXPECT_EQ(scene.lights[0].kind, Light::Kind::spot);
    expect_near(scene.lights[0].color, {3, 1.5f, 0});
    expect_near(scene.lights[0].position, {1, 2, 3});
    expect_near(scene.lights[0].direction, {0, -1, 0});
    EXPECT_FLOAT_EQ(scene.lights[0].range, 7);
    EXPECT_FLOAT_EQ(scene.lights[0].outer_cone, 0.2f);
    expect_near(scene.lights[1].direction, {0, 0, -1});
    EXPECT_EQ(scene.nodes[3].light, 0);
}

/// A square with a skin of one joint, a morph target, and an animation of its node.
json moving_square() {
    json gltf = square();
    const size_t times = add_accessor(gltf, pack<float>({0, 0.5f, 2.5f}), 5126, "SCALAR", 3);
    const size_t places = add_accessor(gltf, pack<float>({0, 0, 0, 1, 0, 0, 3, 0, 0}), 5126, "VEC3", 3);
    const size_t joints = add_accessor(gltf, std::string(16, '\0'), 5121, "VEC4", 4);
    const size_t weights =
        add_accessor(gltf, pack<float>({2, 0, 0, 0, 2, 0, 0, 0, 2, 0, 0, 0, 2, 0, 0, 0}), 5126, "VEC4", 4);
    gltf["animations"] = {{{"name", "walk"},
                           {"samplers", {{{"input", times}, {"output", places}}}},
                           {"channels", {{{"sampler", 0}, {"target", {{"node", 1}, {"path", "translation"}}}}}}}};
    gltf["skins"] = {{{"joints", {1}}}};
    gltf["nodes"][0]["skin"] = 0;
    gltf["nodes"].push_back({{"name", "bone"}});
    gltf["scenes"][0]["nodes"].push_back(1);
    primitive(gltf)["attributes"]["JOINTS_0"] = joints;
    primitive(gltf)["attributes"]["WEIGHTS_0"] = weights;
    primitive(gltf)["targets"] = json::array({{{"POSITION", 0}}});
    gltf["meshes"][0]["weights"] = {1};
    return gltf;
}

TEST(GltfNodes, AnimationsSkinsAndMorphTargets) {
    const TempFolder folder;
    Scene scene = load(folder, moving_square());
    ASSERT_EQ(scene.animations.size(), 1u);
    EXPECT_EQ(scene.animations[0].name, "walk");
    EXPECT_FLOAT_EQ(scene.animations[0].duration, 2.5f);
    ASSERT_EQ(scene.skins.size(), 1u);
    EXPECT_TRUE(has_note(scene, "4 vertices whose joint weights do not sum to one rescaled"));
    const std::vector<glm::vec3> bound = scene.meshes[0].primitives[0].positions;
    const Geometry rest = flatten(scene);
    const Geometry moved = flatten(scene, moment_of(scene, "walk", 1.5));
    for (size_t i = 0; i < bound.size(); i++) {
        expect_near(rest.positions[i], 2.f * bound[i]);  // the target of weight 1 is the square itself
        expect_near(moved.positions[i], 2.f * bound[i] + glm::vec3(2, 0, 0));
    }
}

TEST(GltfNodes, BadAnimationsAndSkinsAreRefused) {
    const TempFolder folder;
    const auto refuse = [&](const std::function<void(json&)>& spoil, const std::string& part) {
        json gltf = moving_square();
        spoil(gltf);
        EXPECT_MENTIONS(error_of(folder, gltf), part);
    };
    refuse(
        [](json& g) {
            g["animations"][0]["samplers"][0]["input"] =
                add_accessor(g, pack<float>({0, 0.5f, 0.5f}), 5126, "SCALAR", 3);
        },
        "key 2 is not after the one before");
    refuse(
        [](json& g) {
            g["animations"][0]["samplers"][0]["input"] = add_accessor(g, pack<float>({0, NAN, 1}), 5126, "SCALAR", 3);
        },
        "of key 1 is no number of seconds");
    refuse(
        [](json& g) {
            g["animations"][0]["samplers"][0]["output"] = add_accessor(g, pack<float>({0, 0, 0}), 5126, "VEC3", 1);
        },
        "3 keys need 9 numbers, the output has 3");
    refuse([](json& g) { g["animations"][0]["samplers"][0]["interpolation"] = "BEZIER"; }, "\"BEZIER\" is unknown");
    refuse([](json& g) { g["animations"][0]["channels"][0]["sampler"] = 3; }, "sampler 3 is out of range");
    refuse([](json& g) { g["animations"][0]["channels"][0]["target"]["node"] = 9; }, "9 is out of range");
    refuse(
        [](json& g) {
            primitive(g)["attributes"]["JOINTS_0"] = add_accessor(g, std::string(16, '\1'), 5121, "VEC4", 4);
        },
        "follows joint 1, the skin has 1");
    refuse([](json& g) { g["skins"][0]["joints"] = {7}; }, "7 is out of range");
    refuse([](json& g) { g["scenes"][0]["nodes"] = {0}; }, "joint 0 is not part of the scene");
    refuse([](json& g) { g["skins"][0]["inverseBindMatrices"] = 0; }, "inverseBindMatrices needs a 4x4 matrix");
    refuse([](json& g) { g["nodes"][1]["children"] = {1}; }, "reached twice");
}

TEST(GltfNodes, MirroredAndFlattenedNodes) {
    const TempFolder folder;
    json gltf = square();
    gltf["nodes"][0] = {{"mesh", 0}, {"scale", {-1, 1, 1}}};
    const Geometry mirrored = flatten(load(folder, gltf));
    const glm::uvec3 t = mirrored.triangles[0];
    const glm::vec3 face = glm::cross(mirrored.positions[t.y] - mirrored.positions[t.x],
                                      mirrored.positions[t.z] - mirrored.positions[t.x]);
    expect_near(mirrored.normals[t.x], {0, 0, 1});
    expect_near(glm::normalize(face), {0, 0, 1});
    for (const auto& scale : {json{1, 1, 0}, json{0, 0, 0}, json{1, 0, 1}}) {
        gltf["nodes"][0]["scale"] = scale;
        for (const glm::vec3& n : flatten(load(folder, gltf)).normals) EXPECT_NEAR(glm::length(n), 1, 1e-5);
    }
}

TEST(GltfNodes, RotationOfPi) {
    const TempFolder folder;
    json gltf = square();
    gltf["nodes"][0] = {{"mesh", 0}, {"rotation", {0, std::sin(pi / 2), 0, std::cos(pi / 2)}}};
    const Geometry geometry = flatten(load(folder, gltf));
    expect_near(geometry.positions[geometry.triangles[0].y], {-1, 0, 0});
}

}  // namespace
}  // namespace peelray::testing
