// The box that does not depend on the moment, and the camera that goes round.
#include "motion/bounds.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "motion/animation.h"
#include "scene/picture.h"

namespace peelray {
namespace {

using Path = AnimationChannel::Path;
using Interpolation = AnimationChannel::Interpolation;

/// Two triangles from (0, 0, 0) to (1, 1, 0): one of a node that stands, one of a node that animations move.
Scene pair(size_t copies = 1) {
    Scene scene;
    scene.name = "pair";
    scene.materials.resize(1);
    Primitive p;
    for (uint32_t i = 0; i < copies; i++) {
        p.positions.insert(p.positions.end(), {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
        p.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    p.positions.push_back({99, 99, 99});  // of no triangle
    p.normals.assign(p.positions.size(), {0, 0, 1});
    scene.meshes.push_back({"triangle", {p}, {}});
    scene.nodes.resize(2);
    scene.nodes[0].mesh = scene.nodes[1].mesh = 0;
    scene.nodes[1].fixed = false;
    return scene;
}

void add_animation(Scene& scene, const char* name, Interpolation interpolation, std::vector<float> times,
                   std::vector<float> values, Path path = Path::translation) {
    const uint32_t width = path == Path::rotation ? 4 : 3;
    const float duration = times.back();
    scene.animations.push_back(
        {name, duration, {{1, path, interpolation, width, std::move(times), std::move(values)}}});
}

/// Around all that is visible and reached.
Box bounds_over(const Scene& scene, const std::string& which, Counted counted = Counted::visible) {
    Box box;
    visit_reach(scene, which, counted, [&](std::span<const glm::vec3> points) {
        for (const glm::vec3& p : points) box.add(p);
    });
    return box;
}

TEST(Bounds, AtRestAreThoseOfTheTriangles) {
    const Scene scene = pair();
    const Geometry geometry = flatten(scene);
    EXPECT_EQ(bounds(scene, at_rest(scene)).lower, geometry.lower);
    EXPECT_EQ(bounds(scene, at_rest(scene)).upper, geometry.upper);
    EXPECT_EQ(bounds(scene, at_rest(scene)).upper, glm::vec3(1, 1, 0));
}

TEST(Bounds, ReachWhereverTheAnimationGoes) {
    Scene scene = pair();
    add_animation(scene, "there", Interpolation::linear, {0, 2}, {0, 0, 0, 5, 0, 0});
    add_animation(scene, "up", Interpolation::linear, {0, 1}, {0, 0, 0, 0, 7, 0});
    // A jump that lasts a thousandth of the whole: only its keys tell of it.
    add_animation(scene, "jump", Interpolation::step, {0, 0.5003f, 0.5013f, 1}, {0, 0, 0, 0, 0, -9, 0, 0, 0, 0, 0, 0});
    // Half a turn about z from one key to the next: the ends alone would not show how far it swings.
    add_animation(scene, "swing", Interpolation::linear, {0, 1}, {0, 0, 0, 1, 0, 0, 1, 0}, Path::rotation);
    EXPECT_EQ(bounds_over(scene, "there").upper, glm::vec3(6, 1, 0));
    EXPECT_EQ(bounds_over(scene, "up").upper, glm::vec3(1, 8, 0));
    EXPECT_EQ(bounds_over(scene, "jump").lower, glm::vec3(0, 0, -9));
    const Box swing = bounds_over(scene, "swing");
    EXPECT_NEAR(swing.lower.x, -1, 1e-3);
    EXPECT_NEAR(swing.upper.y, 1, 1e-3);
    const Box all = bounds_over(scene, "all");
    EXPECT_NEAR(all.lower.x, -1, 1e-3);
    EXPECT_THROW(bounds_over(scene, "sideways"), Error);
}

TEST(Bounds, DoNotDependOnTheMomentAtHand) {
    Scene scene = pair();
    add_animation(scene, "there", Interpolation::linear, {0, 2}, {0, 0, 0, 5, 0, 0});
    const Box first = bounds_over(scene, "0");
    Scene again = pair();
    again.animations = scene.animations;
    const Box second = bounds_over(again, "there");
    EXPECT_EQ(first.lower, second.lower);
    EXPECT_EQ(first.upper, second.upper);
}

TEST(Bounds, KeepTheTipsOfLargeMeshes) {
    // So many vertices that most are left out, and three that stick out.
    Scene scene = pair(20000);
    Primitive& p = scene.meshes[0].primitives[0];
    p.positions[30001] = {3, 0, 0};
    p.positions[30004] = {0, -4, 0};
    p.positions[30007] = {0, 0, 5};
    add_animation(scene, "there", Interpolation::linear, {0, 2}, {0, 0, 0, 10, 20, 30});
    const Box box = bounds_over(scene, "there");
    EXPECT_EQ(box.lower, glm::vec3(0, -4, 0));
    EXPECT_EQ(box.upper, glm::vec3(13, 21, 35));
}

TEST(Bounds, FollowTargetsThatAreMadeLater) {
    Scene scene = pair();
    scene.meshes[0].primitives[0].make_targets = [](const Primitive& p) {
        return std::vector<MorphTarget>{{std::vector<glm::vec3>(p.positions.size(), glm::vec3(0, 0, 2)), {}}};
    };
    scene.animations.push_back({"morph", 1, {{1, Path::weights, Interpolation::linear, 1, {0, 1}, {0, 1.5f}}}});
    complete_targets(scene);
    EXPECT_EQ(bounds_over(scene, "morph").upper, glm::vec3(1, 1, 3));
}

TEST(Bounds, FollowSkinsAndMorphTargets) {
    Scene scene = pair();
    Primitive& p = scene.meshes[0].primitives[0];
    p.targets.push_back({std::vector<glm::vec3>(p.positions.size(), glm::vec3(0, 0, 2)), {}});
    scene.nodes[1].weights = {0};
    scene.animations.push_back({"morph", 1, {{1, Path::weights, Interpolation::linear, 1, {0, 1}, {0, 1.5f}}}});
    EXPECT_EQ(bounds_over(scene, "morph").upper, glm::vec3(1, 1, 3));

    Scene skinned = pair();
    skinned.meshes[0].primitives[0].joints.assign(skinned.meshes[0].primitives[0].positions.size(), JointWeights{});
    for (JointWeights& joints : skinned.meshes[0].primitives[0].joints) joints.weights[0] = 1;
    skinned.skins.push_back({"skin", {1}, {glm::mat4(1)}});
    skinned.nodes[0].skin = 0;
    skinned.nodes[1].mesh = -1;
    add_animation(skinned, "there", Interpolation::linear, {0, 2}, {0, 0, 0, 5, 0, 0});
    EXPECT_EQ(bounds_over(skinned, "there").upper, glm::vec3(6, 1, 0));
}

TEST(Bounds, TheRestPoseCountsOnlyWhereItIsShown) {
    Scene scene = pair();
    scene.nodes[1].local[3] = glm::dvec4(0, -50, 0, 1);
    scene.nodes[1].rest.translation = {0, -50, 0};
    add_animation(scene, "there", Interpolation::linear, {0, 2}, {1, 0, 0, 5, 0, 0});
    EXPECT_EQ(bounds_over(scene, "there").lower, glm::vec3(0));
    EXPECT_EQ(bounds_over(scene, "there").upper, glm::vec3(6, 1, 0));
    EXPECT_EQ(bounds_over(scene, "").lower, glm::vec3(0, -50, 0));
    EXPECT_EQ(bounds_over(scene, "").upper, glm::vec3(1, 1, 0));
}

TEST(Bounds, WhatAlphaMasksLeaveNothingOfDoesNotCount) {
    Scene scene = pair();
    scene.materials.resize(2);
    scene.meshes.push_back(scene.meshes[0]);
    scene.meshes[1].primitives[0].material = 1;
    scene.nodes[1].mesh = 1;
    scene.nodes[1].local[3] = glm::dvec4(0, 70, 0, 1);
    Material& masked = scene.materials[1];
    Primitive& p = scene.meshes[1].primitives[0];
    const auto counts = [&] {
        EXPECT_EQ(bounds_over(scene, "", Counted::all).upper.y, 71);
        EXPECT_EQ(bounds(scene, at_rest(scene)).upper.y, 71);
        return bounds_over(scene, "").upper.y == 71;
    };
    masked.alpha = 0;
    EXPECT_TRUE(counts()) << "opaque, whatever the alpha";
    masked.alpha_cutoff = 0.5f;
    EXPECT_FALSE(counts());
    masked.alpha = 0.5f;
    EXPECT_TRUE(counts());
    p.colors.assign(p.positions.size(), glm::vec4(1, 1, 1, 0.9f));
    EXPECT_FALSE(counts());
    p.colors[1].w = 1;
    EXPECT_TRUE(counts());
    masked.base_color_texture = 0;
    scene.textures.resize(1);
    scene.textures[0].texels = {0x00FFFFFF, 0xFEFFFFFF};
    EXPECT_FALSE(counts());
    scene.textures[0].texels[0] = 0xFF000000;
    EXPECT_TRUE(counts());
    scene.textures[0].texels.clear();
    scene.textures[0].deep_texels = {0xFFFEull << 48};
    EXPECT_FALSE(counts());
    scene.textures[0].deep_texels = {0xFFFFull << 48};
    EXPECT_TRUE(counts());
}

TEST(Turned, GoesRoundTheLookPoint) {
    Camera camera;
    camera.eye = {3, 2, 5};
    camera.look = {1, 1, 1};
    camera.up = {0.5f, 1, 0};
    const Camera same = turned(camera, 0);
    EXPECT_EQ(same.eye, camera.eye);
    EXPECT_EQ(same.up, camera.up);
    // A quarter, counter-clockwise from above: what pointed along +x points along -z.
    const Camera quarter = turned(camera, 0.25);
    EXPECT_LT(glm::length(quarter.eye - glm::dvec3(5, 2, -1)), 1e-5f);
    EXPECT_LT(glm::length(quarter.up - glm::vec3(0, 1, -0.5f)), 1e-6f);
    EXPECT_EQ(quarter.look, camera.look);
    EXPECT_LT(glm::length(turned(camera, 1).eye - camera.eye), 1e-5f);
}

}  // namespace
}  // namespace peelray
