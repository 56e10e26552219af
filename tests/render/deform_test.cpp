// Skins, morph targets and what is generated, computed on the GPU: against the CPU.
#include <filesystem>
#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "loaders/load.h"
#include "motion/animation.h"
#include "moving.h"

namespace peelray {
namespace {

using glm::vec3;
using Path = AnimationChannel::Path;

class DeformTest : public DeviceTest {
  protected:
    float unit() { return float(random_() >> 8) / 16777216.0f; }
    vec3 point(float size) { return size * (2.0f * vec3(unit(), unit(), unit()) - 1.0f); }

    /// A tube with many joints in a chain that all turn, up to eight of them at a vertex, some vertices with none.
    Scene chain(uint32_t joints, bool with_targets) {
        Scene scene;
        scene.name = "chain";
        scene.materials.resize(1);
        Primitive shape = torus({0, 0, 0}, 2, 0.4f, 40, 16);
        for (size_t i = 0; i < shape.positions.size(); i++) {
            JointWeights vertex;
            float sum = 0;
            const size_t count = i % 11 == 0 ? 0 : 1 + i % 8;
            for (size_t k = 0; k < count; k++) {
                vertex.joints[k] = uint16_t(random_() % joints);
                vertex.weights[k] = unit() + 0.01f;
                sum += vertex.weights[k];
            }
            for (float& w : vertex.weights) w /= std::max(sum, 1e-9f);
            shape.joints.push_back(vertex);
        }
        if (with_targets) {
            for (int k = 0; k < 3; k++) {
                MorphTarget target;
                for (size_t i = 0; i < shape.positions.size() && k != 2; i++) target.positions.push_back(point(0.3f));
                for (size_t i = 0; i < shape.positions.size() && k != 1; i++) target.normals.push_back(point(0.3f));
                shape.targets.push_back(target);
            }
        }
        scene.meshes.push_back({"tube", {shape}, {0.5f}});
        Node tube;
        tube.mesh = 0;
        tube.skin = 0;
        tube.rest.translation = {3, 1, 0};
        tube.fixed = false;
        scene.nodes.push_back(tube);
        Skin skin;
        Animation animation{"turn", 2, {}};
        for (uint32_t i = 0; i < joints; i++) {
            Node joint;
            joint.parent = i == 0 ? -1 : int(i);
            joint.rest.translation = {0.3f, 0.05f * float(i), 0};
            joint.fixed = false;
            scene.nodes.push_back(joint);
            skin.joints.push_back(int(i) + 1);
            skin.inverse_bind.push_back(glm::translate(glm::mat4(1), point(0.5f)));
            const glm::quat a = glm::normalize(glm::quat(1, unit(), unit(), unit())),
                            b = glm::normalize(glm::quat(1, unit() - 1, unit(), unit()));
            animation.channels.push_back({int(i) + 1,
                                          Path::rotation,
                                          AnimationChannel::Interpolation::linear,
                                          4,
                                          {0, 2},
                                          {a.x, a.y, a.z, a.w, b.x, b.y, b.z, b.w}});
        }
        if (with_targets)
            animation.channels.push_back({0,
                                          Path::weights,
                                          AnimationChannel::Interpolation::linear,
                                          3,
                                          {0, 1, 2},
                                          {0, 0, 0, 1, -0.5f, 0, 0, 2, 1}});
        animation.channels.push_back(
            {0, Path::translation, AnimationChannel::Interpolation::linear, 3, {0, 2}, {3, 1, 0, 5, 1, 2}});
        for (Node& node : scene.nodes) node.local = node.rest.matrix();
        scene.skins.push_back(skin);
        scene.animations.push_back(animation);
        return scene;
    }

    void expect_same(Scene& scene, const std::string& which, std::initializer_list<double> times, double tolerance) {
        MovedScene moved(device(), scene, which);
        for (const double time : times) {
            SCOPED_TRACE(time);
            moved.pose(time);
            const auto worst = moved.compare();
            EXPECT_LT(worst.position, tolerance);
            EXPECT_LT(worst.normal, 2e-3);
        }
    }

  private:
    std::mt19937 random_{4711};
};

TEST_F(DeformTest, SkinsWithUpToEightWeights) {
    for (const uint32_t joints : {1u, 2u, 30u, 300u}) {
        SCOPED_TRACE(joints);
        Scene scene = chain(joints, false);
        // Hundreds of turns in a row: coordinates and their rounding grow.
        expect_same(scene, "0", {0, 0.3, 1.1, 2}, joints > 100 ? 2e-4 : 2e-5);
    }
}

TEST_F(DeformTest, MorphTargetsUnderASkin) {
    Scene scene = chain(12, true);
    expect_same(scene, "0", {0, 0.5, 1.4, 0.5, 0}, 2e-5);
}

TEST_F(DeformTest, FlatShadedTrianglesKeepTheirOwnNormals) {
    Scene scene;
    scene.materials.resize(1);
    const Primitive ball = sphere({0, 0, 0}, 1, 4);
    Primitive flat;
    flat.flat = true;
    MorphTarget target;
    for (const glm::uvec3& t : ball.triangles)
        for (int k = 0; k < 3; k++) {
            flat.positions.push_back(ball.positions[t[k]]);
            flat.normals.push_back({0, 0, 1});  // to be replaced
            target.positions.push_back({0, 0.7f * ball.positions[t[k]].x, 0});
        }
    for (uint32_t i = 0; i < flat.positions.size(); i += 3) flat.triangles.push_back({i, i + 1, i + 2});
    flat.targets.push_back(target);
    scene.meshes.push_back({"flat", {flat, ball}, {}});  // the other primitive stays smooth
    scene.nodes.resize(1);
    scene.nodes[0].mesh = 0;
    scene.animations.push_back(
        {"", 1, {{0, Path::weights, AnimationChannel::Interpolation::linear, 1, {0, 1}, {0, 1}}}});
    expect_same(scene, "0", {0, 0.6, 1}, 2e-6);
}

TEST_F(DeformTest, ScalesThatTurnThingsInsideOut) {
    Scene scene;
    scene.materials.resize(1);
    scene.meshes.push_back({"ball", {sphere({0.3f, 0, 0}, 1, 4)}, {}});
    scene.nodes.resize(2);
    for (Node& node : scene.nodes) node.fixed = false;
    scene.nodes[1].mesh = 0;
    scene.nodes[1].parent = 0;
    scene.nodes[1].rest.translation = {0, 2, 0};
    scene.animations.push_back(
        {"", 1, {{0, Path::scale, AnimationChannel::Interpolation::linear, 3, {0, 1}, {1, 1, 1, -2, 1, 0.5f}}}});
    expect_same(scene, "0", {0, 0.2, 0.9, 0.4, 1, 0}, 5e-6);
}

TEST_F(DeformTest, ThingsMoveAsTheirNodes) {
    Scene scene;
    scene.materials.resize(1);
    scene.meshes.push_back({"ball", {sphere({0.3f, 0, 0}, 1, 4)}, {}});
    scene.nodes.resize(3);
    for (Node& node : scene.nodes) node.fixed = false;
    scene.nodes[1].mesh = scene.nodes[2].mesh = 0;
    scene.nodes[1].parent = 0;
    scene.nodes[2].parent = 1;
    scene.nodes[1].rest.scale = {-1, 1, 0.7f};  // a mirror
    scene.nodes[2].rest.translation = {0, 2, 0};
    const float s = std::sqrt(0.5f);
    for (const int node : {0, 2})
        scene.animations.push_back(
            {"",
             1,
             {{node, Path::rotation, AnimationChannel::Interpolation::linear, 4, {0, 1}, {0, 0, 0, 1, s, 0, 0, s}}}});
    MovedScene moved(device(), scene, "all");
    EXPECT_TRUE(moved.assembly.pieces.empty()) << "nothing has to be rebuilt";
    for (const double time : {0.0, 0.5, 0.9}) {
        moved.pose(time);
        EXPECT_LT(moved.compare().position, 5e-6);
    }
}

TEST_F(DeformTest, BoundsAreThoseOfTheVertices) {
    Scene scene = chain(12, true);
    MovedScene moved(device(), scene, "0");
    for (const double time : {0.0, 1.7}) {
        moved.pose(time);
        const Geometry geometry = flatten(scene, moved.moment);
        const auto boxes = moved.commands.download<PeelrayBox>(moved.gpu.instances.boxes(), 8);
        const float slack = 1e-4f + 2 * glm::length(geometry.upper - geometry.lower) / 16;
        for (int k = 0; k < 3; k++) {
            EXPECT_LE(boxes[0].lower[k], geometry.lower[k]);
            EXPECT_GE(boxes[0].upper[k], geometry.upper[k]);
            EXPECT_LT(geometry.lower[k] - boxes[0].lower[k], slack);
        }
    }
}

TEST_F(DeformTest, WaterIsThatOfTheCpu) {
    for (const uint32_t triangles : {200u, 5000u}) {
        Scene scene = load_scene(fmt::format("builtin:waves:{}", triangles));
        MovedScene moved(device(), scene, "0");
        EXPECT_EQ(moved.assembly.surfaces.size(), 1u);
        double highest = 0;
        for (const double time : {0.0, 1 / 120.0, 0.4, 2.123, 5.0, 0.4}) {
            SCOPED_TRACE(time);
            moved.pose(time);
            const auto worst = moved.compare();
            EXPECT_LT(worst.position, 2e-5);
            EXPECT_LT(worst.normal, 2e-3);
            for (const double h : moved.simulation.waters()[0].heights) highest = std::max(highest, std::abs(h));
        }
        EXPECT_GT(highest, 0.02) << "there are waves";
        EXPECT_LT(highest, 0.25) << "and they do not grow";
    }
}

TEST_F(DeformTest, ClothIsThatOfTheCpu) {
    for (const uint32_t triangles : {8u, 5000u}) {
        Scene scene = load_scene(fmt::format("builtin:cloth:{}", triangles));
        MovedScene moved(device(), scene, "0");
        EXPECT_EQ(moved.assembly.surfaces.size(), 1u);
        for (const double time : {0.0, 0.3, 1.237, 0.3}) {
            SCOPED_TRACE(time);
            moved.pose(time);
            const auto worst = moved.compare();
            EXPECT_LT(worst.position, 1e-6);
            EXPECT_LT(worst.normal, 1e-4);
        }
    }
}

TEST_F(DeformTest, TheFountainIsThatOfTheCpu) {
    Scene scene = load_scene("builtin:particles:500");
    MovedScene moved(device(), scene, "0");
    for (const double time : {0.0, 1.7, 5.9, 100.3}) {
        SCOPED_TRACE(time);
        moved.pose(time);
        EXPECT_LT(moved.compare().position, 2e-4);  // a phase of a float, a thousandth of a bounce
    }
}

TEST_F(DeformTest, ModelsMoveAsOnTheCpu) {
    const std::string folder = PEELRAY_MODELS "/skinned";
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << "the test models are not here: " << folder;
    size_t compared = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
        const std::string extension = entry.path().extension();
        if (extension != ".glb" && extension != ".gltf") continue;
        SCOPED_TRACE(entry.path().filename());
        Scene scene;
        try {
            scene = load_scene(entry.path());
        } catch (const Error&) {
            continue;
        }
        if (scene.animations.empty()) continue;
        MovedScene moved(device(), scene, "all");
        const double duration = scene.animations[0].duration;
        for (const double share : {0.0, 0.31, 0.77, 1.4}) {
            moved.pose(share * duration);
            const Geometry geometry = flatten(scene, moved.moment);
            const auto worst = moved.compare();
            EXPECT_LT(worst.position, 2e-6 * glm::length(geometry.upper - geometry.lower) + 1e-6);
            EXPECT_LT(worst.normal, 5e-3);
        }
        compared++;
    }
    EXPECT_GT(compared, 10u);
}

}  // namespace
}  // namespace peelray
