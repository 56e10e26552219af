// Key frames, skins and morph targets against closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "base/error.h"
#include "loaders/load.h"
#include "motion/animation.h"
#include "scene/scene.h"

namespace peelray {
namespace {

using Path = AnimationChannel::Path;
using Interpolation = AnimationChannel::Interpolation;

AnimationChannel channel(Path path, Interpolation interpolation, std::vector<float> times, std::vector<float> values) {
    const uint32_t width = path == Path::rotation ? 4 : 3;
    return {0, path, interpolation, width, std::move(times), std::move(values)};
}

TEST(Keys, StepHoldsTheValueBefore) {
    const auto c = channel(Path::translation, Interpolation::step, {1, 2, 4}, {1, 0, 0, 2, 0, 0, 3, 0, 0});
    for (const auto& [time, value] :
         std::vector<std::pair<float, float>>{{0, 1}, {1, 1}, {1.99f, 1}, {2, 2}, {3.9f, 2}, {4, 3}, {9, 3}})
        EXPECT_EQ(c.at(time)[0], value) << time;
}

TEST(Keys, LinearGoesStraight) {
    const auto c = channel(Path::scale, Interpolation::linear, {1, 2, 4}, {1, 5, 0, 2, 5, 0, 6, 5, 0});
    for (const auto& [time, value] :
         std::vector<std::pair<float, float>>{{0, 1}, {1.5f, 1.5f}, {2, 2}, {3, 4}, {4, 6}, {5, 6}})
        EXPECT_FLOAT_EQ(c.at(time)[0], value) << time;
    EXPECT_EQ(c.at(3)[1], 5);
}

TEST(Keys, CubicFollowsAPolynomial) {
    // x(t) = t³ - 2t with its own derivative as tangents: Hermite's interpolation repeats any cubic.
    const auto x = [](double t) { return t * t * t - 2 * t; };
    const auto slope = [](double t) { return 3 * t * t - 2; };
    AnimationChannel c = channel(Path::translation, Interpolation::cubic, {0.5f, 1.5f, 4}, {});
    for (const float t : c.times)
        for (const double value : {slope(t), x(t), slope(t)}) c.values.insert(c.values.end(), {float(value), 0, 1});
    for (double t = 0.5; t <= 4; t += 0.125) EXPECT_NEAR(c.at(float(t))[0], x(t), 2e-4 * (1 + std::abs(x(t)))) << t;
    EXPECT_FLOAT_EQ(c.at(0)[0], float(x(0.5)));
    EXPECT_FLOAT_EQ(c.at(9)[0], float(x(4)));
}

TEST(Keys, RotationsTakeTheShorterWay) {
    const auto turn = [](double degrees) {
        const double half = degrees * M_PI / 360;
        return std::vector<float>{0, 0, float(std::sin(half)), float(std::cos(half))};
    };
    std::vector<float> values = turn(10);
    const auto end = turn(70);
    for (const float v : end) values.push_back(-v);  // the same rotation, from the other side
    const auto c = channel(Path::rotation, Interpolation::linear, {0, 1}, values);
    for (const double share : {0.25, 0.5, 0.9}) {
        const auto got = c.at(float(share)), wanted = turn(10 + 60 * share);
        EXPECT_NEAR(std::abs(got[2] * wanted[2] + got[3] * wanted[3]), 1, 1e-6) << share;
    }
    // Cubic rotations come out unit.
    const auto q = channel(Path::rotation, Interpolation::cubic, {0, 1},
                           {0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0});
    const auto half = q.at(0.5f);
    EXPECT_NEAR(half[2] * half[2] + half[3] * half[3], 1, 1e-6);
    EXPECT_NEAR(half[2], half[3], 1e-6);
}

/// A strip from y = 0 to 2 with a joint at 0 and one at 1, as a scene of nodes: mesh, lower joint, upper joint (a
/// child).
Scene strip() {
    Scene scene;
    scene.name = "strip";
    scene.materials.resize(1);
    Primitive p;
    for (int i = 0; i <= 4; i++)
        for (const float x : {-0.1f, 0.1f}) {
            p.positions.push_back({x, 0.5f * float(i), 0});
            p.normals.push_back({0, 0, 1});
            JointWeights joints;
            joints.joints = {0, 1};
            const float upper = i < 2 ? 0 : i == 2 ? 0.5f : 1;
            joints.weights = {1 - upper, upper};
            p.joints.push_back(joints);
        }
    for (uint32_t i = 0; i < 4; i++) {
        p.triangles.push_back({2 * i, 2 * i + 1, 2 * i + 3});
        p.triangles.push_back({2 * i, 2 * i + 3, 2 * i + 2});
    }
    scene.meshes.push_back({"strip", {p}, {}});
    scene.nodes.resize(3);
    scene.nodes[0].mesh = 0;
    scene.nodes[0].skin = 0;
    scene.nodes[0].rest.translation = {50, 0, 0};  // the node of a skinned mesh does not move it
    scene.nodes[1].rest.translation = {0, 0, 0};
    scene.nodes[2].parent = 1;
    scene.nodes[2].rest.translation = {0, 1, 0};
    for (Node& node : scene.nodes) {
        node.fixed = false;
        node.local = node.rest.matrix();
    }
    glm::mat4 down(1);
    down[3] = {0, -1, 0, 1};
    scene.skins.push_back({"skin", {1, 2}, {glm::mat4(1), down}});
    const float s = std::sqrt(0.5f);
    AnimationChannel bend = channel(Path::rotation, Interpolation::linear, {0, 2}, {0, 0, 0, 1, 0, 0, s, s});
    bend.node = 2;
    scene.animations.push_back({"bend", 2, {bend}});
    AnimationChannel move = channel(Path::translation, Interpolation::linear, {0, 1}, {0, 0, 0, 0, 0, 3});
    move.node = 1;
    scene.animations.push_back({"move", 1, {move}});
    return scene;
}

TEST(Skin, BendsAStrip) {
    Scene scene = strip();
    const Geometry rest = flatten(scene);
    for (size_t i = 0; i < rest.positions.size(); i++)
        EXPECT_LT(glm::length(rest.positions[i] - scene.meshes[0].primitives[0].positions[i]), 1e-6f) << i;
    const Geometry bent = flatten(scene, moment_of(scene, "bend", 1));  // 45° about z at (0, 1, 0)
    const double c = std::sqrt(0.5);
    for (size_t i = 0; i < rest.positions.size(); i++) {
        const glm::dvec3 p = rest.positions[i];
        const glm::dvec3 turned(c * p.x - c * (p.y - 1), 1 + c * p.x + c * (p.y - 1), 0);
        const double upper = i < 4 ? 0 : i < 6 ? 0.5 : 1;
        EXPECT_LT(glm::length(glm::dvec3(bent.positions[i]) - glm::mix(p, turned, upper)), 1e-6) << i;
        EXPECT_LT(glm::length(bent.normals[i] - glm::vec3(0, 0, 1)), 1e-6f) << i;
    }
}

TEST(Animate, CarriesACameraWithoutDrift) {
    Scene scene = strip(), fresh = strip();
    for (Scene* each : {&scene, &fresh}) {
        Camera camera;
        camera.eye = {0, 1, 0};
        camera.look = {0, 1, -3.3333333f};
        each->cameras.push_back(camera);
        each->nodes[2].camera = 0;
    }
    for (int i = 0; i < 200; i++) moment_of(scene, "all", 0.013 * i);
    const Camera later = moment_of(scene, "all", 0.7).cameras[0], alone = moment_of(fresh, "all", 0.7).cameras[0];
    EXPECT_EQ(later.look, alone.look);
    EXPECT_EQ(later.eye, alone.eye);
    EXPECT_NEAR(glm::length(later.look - later.eye), 3.3333333f, 1e-5f);
    EXPECT_LT(glm::length(at_rest(scene).cameras[0].look - glm::dvec3(0, 1, -3.3333333f)), 1e-5f);
    EXPECT_EQ(flatten(scene).positions, flatten(strip()).positions);
}

TEST(Animate, ForgetsWhatWasBefore) {
    const Scene scene = strip(), fresh = strip();
    const auto positions = [](const Scene& of, const char* which, double time) {
        return flatten(of, moment_of(of, which, time)).positions;
    };
    EXPECT_FLOAT_EQ(positions(scene, "move", 1)[0].z, 3);
    EXPECT_EQ(positions(scene, "bend", 1.7), positions(fresh, "0", 1.7));
    // Beyond its end it starts again; all at once moves both.
    EXPECT_EQ(positions(fresh, "bend", 1.5), positions(scene, "bend", 3.5));
    EXPECT_FLOAT_EQ(positions(scene, "all", 1)[0].z, 3);
    EXPECT_LT(positions(scene, "all", 1)[9].x, -0.5f);
}

TEST(Animate, CamerasAndLightsFollowTheirNodes) {
    Scene scene = strip();
    scene.cameras.resize(1);
    scene.cameras[0].look = {0, 0, -4};
    scene.cameras[0].eye = {0, 0, 0};
    scene.lights.resize(1);
    scene.nodes[1].camera = scene.nodes[1].light = 0;
    const Moment moment = moment_of(scene, "move", 0.5);
    EXPECT_EQ(moment.cameras[0].eye, glm::dvec3(0, 0, 1.5f));
    EXPECT_EQ(moment.cameras[0].look, glm::dvec3(0, 0, -2.5f));
    EXPECT_EQ(moment.lights[0].position, glm::vec3(0, 0, 1.5f));
}

TEST(Animate, TheMomentBeforeIsThatOfTheFrameBefore) {
    for (const double fps : {30.0, 24.0, 29.97, 1000.0})
        for (const double frame : {1.0, 2.0, 31.0, 57.0, 1000.0, 99999.0})
            EXPECT_EQ(moment_before(frame / fps, fps), (frame - 1) / fps) << frame << " at " << fps;
    EXPECT_EQ(moment_before(0, 30), 0);
    EXPECT_EQ(moment_before(0.01, 30), 0);
    EXPECT_DOUBLE_EQ(moment_before(1.01, 10), 0.91);
}

TEST(Animate, UnknownNamesAreListed) {
    Scene scene = strip();
    const auto message = [&](const std::string& which) -> std::string {
        try {
            moment_of(scene, which, 0);
        } catch (const Error& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_NE(message("run").find("0: bend, 1: move"), std::string::npos);
    EXPECT_NE(message("2").find("'2'"), std::string::npos);
    scene.animations.clear();
    EXPECT_NE(message("0").find("no animation"), std::string::npos);
}

TEST(Morph, MixesTargetsAndKeepsFlatNormalsFlat) {
    Scene scene;
    scene.materials.resize(1);
    Primitive p;
    p.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    p.normals = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
    p.triangles = {{0, 1, 2}};
    p.targets = {{{{0, 0, 0}, {0, 0, 0}, {0, 0, 2}}, {}}, {{{1, 0, 0}, {1, 0, 0}, {1, 0, 0}}, {}}};
    p.flat = true;
    scene.meshes.push_back({"m", {p}, {0.5f, 0}});
    scene.nodes.resize(1);
    scene.nodes[0].mesh = 0;
    Geometry g = flatten(scene);
    EXPECT_EQ(g.positions[2], glm::vec3(0, 1, 1));  // the mesh's own weights
    EXPECT_LT(glm::length(g.normals[0] - glm::normalize(glm::vec3(0, -1, 1))), 1e-6f);
    AnimationChannel weights{0, Path::weights, Interpolation::linear, 2, {0, 1}, {0, 0, 1, 3}};
    scene.animations.push_back({"", 1, {weights}});
    g = flatten(scene, moment_of(scene, "all", 0.5));
    EXPECT_EQ(g.positions[2], glm::vec3(1.5f, 1, 1));
    EXPECT_EQ(g.positions[1], glm::vec3(2.5f, 0, 0));
}

TEST(Models, AnimationsStayFiniteAndMove) {
    const std::string folder = PEELRAY_MODELS "/skinned/";
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << "the test models are not here: " << folder;
    size_t animated = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
        const std::string extension = entry.path().extension();
        if (extension != ".glb" && extension != ".gltf") continue;
        SCOPED_TRACE(entry.path().filename());
        Scene scene;
        try {
            scene = load_scene(entry.path());
        } catch (const Error& error) {
            // Some cases of the generator come without their textures.
            EXPECT_NE(std::string(error.what()).find("no such file"), std::string::npos) << error.what();
            continue;
        }
        for (size_t i = 0; i < scene.animations.size(); i++) {
            const float duration = scene.animations[i].duration;
            const Geometry start = flatten(scene, moment_of(scene, std::to_string(i), 0));
            bool moves = false;
            for (const float share : {0.13f, 0.37f, 0.5f, 0.91f}) {
                const Geometry now = flatten(scene, moment_of(scene, std::to_string(i), share * duration));
                ASSERT_EQ(now.positions.size(), start.positions.size());
                moves |= now.positions != start.positions;
                for (const glm::vec3& n : now.normals) ASSERT_NEAR(glm::length(n), 1, 1e-4);
                const double before = glm::length(start.upper - start.lower),
                             after = glm::length(now.upper - now.lower);
                EXPECT_LT(after, 20 * before + 1);
            }
            animated += moves;
        }
    }
    EXPECT_GT(animated, 20u);
}

}  // namespace
}  // namespace peelray
