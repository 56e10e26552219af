// Scenes taken apart: put together again they are what flatten() gives, and only what changes its shape has to be
// rebuilt.
#include "assembly/assembly.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <glm/gtc/matrix_transform.hpp>

#include "assembly/grouping.h"
#include "base/error.h"
#include "builtin/shapes.h"
#include "loaders/load.h"
#include "motion/animation.h"

namespace peelray {
namespace {

using glm::vec3;
using Path = AnimationChannel::Path;
using Interpolation = AnimationChannel::Interpolation;

glm::mat4 moved(const vec3& by) {
    return glm::translate(glm::mat4(1), by);
}

/// A scene of nodes that each show a mesh.
struct Builder {
    Scene scene;

    Builder() { scene.materials.resize(1); }
    int mesh(Primitive shape) {
        scene.meshes.push_back({"mesh", {std::move(shape)}, {}});
        return int(scene.meshes.size()) - 1;
    }
    int node(int mesh, const vec3& at = vec3(0), int parent = -1) {
        Node node;
        node.mesh = mesh;
        node.parent = parent;
        node.rest.translation = at;
        node.local = node.rest.matrix();
        node.fixed = false;
        scene.nodes.push_back(node);
        return int(scene.nodes.size()) - 1;
    }
    void animate(int node, Path path, std::vector<float> values, std::vector<float> times = {0, 1}) {
        if (scene.animations.empty()) scene.animations.push_back({"all", times.back(), {}});
        const uint32_t width = path == Path::rotation ? 4 : path == Path::weights ? 1 : 3;
        scene.animations[0].channels.push_back({node, path, Interpolation::linear, width, times, std::move(values)});
    }
    void turn(int node) {
        const float s = std::sqrt(0.5f);
        animate(node, Path::rotation, {0, 0, 0, 1, 0, s, 0, s});
    }
    Assembly take_apart(const std::string& which = "0") {
        return assemble(scene, at_rest(scene), motion_of(scene, scene.animations.empty() ? "" : which));
    }
};

/// Puts the bodies that do not deform together again, as they stand at a moment, and compares with flatten().
void expect_whole(const Scene& scene, const Moment& moment, const Assembly& assembly, double tolerance) {
    const Geometry geometry = flatten(scene, moment);
    const std::vector<glm::mat4>& worlds = moment.worlds;
    EXPECT_EQ(assembly.shown, geometry.triangles.size());
    std::vector<int> seen(geometry.triangles.size());
    std::vector<uint32_t> owners(geometry.triangles.size());
    for (uint32_t i = 0; i < geometry.objects.size(); i++)
        for (uint32_t k = 0; k < geometry.objects[i].count; k++) owners[geometry.objects[i].first + k] = i;
    for (const Assembly::Instance& instance : assembly.instances) {
        const glm::mat4 to_world =
            instance.node < 0 ? instance.offset : worlds[size_t(instance.node)] * instance.offset;
        const bool mirrored = glm::determinant(glm::dmat3(to_world)) < 0;
        const Assembly::Body& body = assembly.bodies[instance.body];
        for (uint32_t t = body.first_triangle; t < body.first_triangle + body.triangles; t++) {
            const uint32_t id = instance.first_id + assembly.ids[t];
            ASSERT_LT(id, seen.size());
            seen[id]++;
            ASSERT_EQ(assembly.materials[t], geometry.materials[id]);
            ASSERT_EQ(instance.first_object + assembly.objects[t], owners[id]);
            glm::uvec3 corners = assembly.triangles[t];
            if (mirrored) std::swap(corners.y, corners.z);
            for (int k = 0; k < 3; k++) {
                ASSERT_GE(corners[k], body.first_vertex);
                ASSERT_LT(corners[k], body.first_vertex + body.vertices);
                if (instance.body >= assembly.fixed) continue;
                const vec3& p = assembly.positions[corners[k]];
                ASSERT_TRUE(glm::all(glm::lessThanEqual(body.lower, p)) && glm::all(glm::lessThanEqual(p, body.upper)));
                const uint32_t other = geometry.triangles[id][k];
                ASSERT_LT(glm::length(vec3(to_world * glm::vec4(p, 1)) - geometry.positions[other]), tolerance) << id;
                ASSERT_EQ(assembly.uvs[corners[k]], geometry.uvs[other]);
                if (!geometry.colors.empty()) {
                    ASSERT_EQ(assembly.colors[corners[k]], geometry.colors[other]);
                }
                const glm::dmat3 m(to_world);
                const glm::dmat3 cofactors = glm::transpose(glm::inverse(m)) * std::abs(glm::determinant(m));
                const glm::dvec3 normal = glm::normalize(cofactors * glm::dvec3(assembly.normals[corners[k]]));
                ASSERT_LT(glm::length(normal - glm::dvec3(geometry.normals[other])), 1e-4) << id;
            }
        }
    }
    for (size_t i = 0; i < seen.size(); i++) ASSERT_EQ(seen[i], 1) << "triangle " << i;
}

/// Bodies are in order, without gaps, and so are the instances.
void expect_ordered(const Assembly& assembly) {
    uint32_t triangles = 0, vertices = 0, body = 0;
    for (const Assembly::Body& b : assembly.bodies) {
        EXPECT_EQ(b.first_triangle, triangles);
        EXPECT_EQ(b.first_vertex, vertices);
        triangles += b.triangles;
        vertices += b.vertices;
    }
    EXPECT_EQ(triangles, assembly.triangles.size());
    EXPECT_EQ(vertices, assembly.positions.size());
    EXPECT_EQ(assembly.normals.size(), vertices);
    for (const Assembly::Instance& instance : assembly.instances) {
        EXPECT_TRUE(instance.body == body || instance.body == body + 1);
        body = instance.body;
    }
    EXPECT_EQ(body + 1, assembly.bodies.size());
    EXPECT_LE(assembly.fixed, assembly.bodies.size());
}

TEST(Assembly, WhatStandsStillIsOneBodyInTheWorld) {
    Builder build;
    build.node(build.mesh(sphere({0, 0, 0}, 1, 4)), {1, 2, 3});
    build.node(build.mesh(torus({0, 0, 0}, 1, 0.3f, 12, 8)), {0.2f, 0, 0}, 0);
    const Assembly assembly = build.take_apart();
    EXPECT_EQ(assembly.bodies.size(), 1u);
    EXPECT_EQ(assembly.fixed, 1u);
    ASSERT_EQ(assembly.instances.size(), 1u);
    EXPECT_EQ(assembly.instances[0].node, -1);
    EXPECT_EQ(assembly.instances[0].offset, glm::mat4(1));
    expect_ordered(assembly);
    expect_whole(build.scene, at_rest(build.scene), assembly, 1e-6);
}

TEST(Assembly, WhatMovesAsOneIsOneBodyThatIsNeverRebuilt) {
    Builder build;
    const int ball = build.mesh(sphere({0, 0, 0}, 1, 4)), ring = build.mesh(torus({0, 0, 0}, 1, 0.3f, 12, 8));
    build.node(ball, {9, 0, 0});
    const int root = build.node(ring, {0, 1, 0});
    build.node(build.mesh(sphere({0, 0, 0}, 0.5f, 3)), {0.5f, 0, 0}, root);  // goes with the ring
    build.turn(root);
    const Assembly assembly = build.take_apart();
    ASSERT_EQ(assembly.bodies.size(), 2u);
    EXPECT_EQ(assembly.fixed, 2u);
    EXPECT_TRUE(assembly.pieces.empty());
    expect_ordered(assembly);
    for (const double time : {0.0, 0.3, 1.0}) {
        expect_whole(build.scene, moment_of(build.scene, "0", time), assembly, 3e-6);
    }
}

TEST(Assembly, ChannelsThatChangeNothingMoveNothing) {
    Builder build;
    const int node = build.node(build.mesh(sphere({0, 0, 0}, 1, 4)));
    build.animate(node, Path::translation, {1, 2, 3, 1, 2, 3});
    build.animate(node, Path::scale, {2, 2, 2, 2, 2, 2});
    const Moment moment = moment_of(build.scene, "0", 0);
    const Assembly assembly = assemble(build.scene, moment, motion_of(build.scene, "0"));
    ASSERT_EQ(assembly.instances.size(), 1u);
    EXPECT_EQ(assembly.instances[0].node, -1);
    EXPECT_TRUE(assembly.pieces.empty());
    expect_whole(build.scene, moment, assembly, 1e-6);
}

TEST(Assembly, AScaleThatChangesIsADeformation) {
    Builder build;
    const int mesh = build.mesh(sphere({0, 0, 0}, 1, 4));
    const int root = build.node(-1), child = build.node(mesh, {1, 0, 0}, root);
    build.node(mesh, {5, 0, 0});
    build.animate(root, Path::scale, {1, 1, 1, 0, 2, 2});
    build.turn(child);
    const Assembly assembly = build.take_apart();
    EXPECT_EQ(assembly.fixed, 1u);
    ASSERT_EQ(assembly.pieces.size(), 1u);
    EXPECT_EQ(assembly.pieces[0].node, child);
    expect_ordered(assembly);
    for (const double time : {0.0, 0.5}) {
        expect_whole(build.scene, moment_of(build.scene, "0", time), assembly, 1e-6);
    }
}

TEST(Assembly, AMatrixWithoutInverseIsADeformationWhereItMoves) {
    Builder build;
    const int mesh = build.mesh(sphere({0, 0, 0}, 1, 4));
    const int root = build.node(-1), flat = build.node(mesh, {1, 0, 0}, root), still = build.node(mesh, {5, 0, 0});
    for (const int node : {flat, still}) {
        build.scene.nodes[size_t(node)].local = glm::scale(glm::mat4(1), {1, 0, 1});
        build.scene.nodes[size_t(node)].fixed = true;
    }
    build.turn(root);
    const Assembly assembly = build.take_apart();
    ASSERT_EQ(assembly.pieces.size(), 1u);
    EXPECT_EQ(assembly.pieces[0].node, flat);
    EXPECT_EQ(assembly.fixed, 1u) << "the other is as flat as it is";
}

TEST(Assembly, LargeMeshesAreShared) {
    Builder build;
    const int mesh = build.mesh(sphere({0, 0, 0}, 1, 12));
    for (int i = 0; i < 5; i++) build.node(mesh, {3.0f * float(i), 0, 0});
    build.scene.nodes[3].local = glm::scale(moved({9, 0, 0}), {-1, 1, 1.5f});  // mirrored
    build.scene.nodes[3].fixed = true;
    const Assembly assembly = build.take_apart();
    ASSERT_EQ(assembly.bodies.size(), 1u);
    EXPECT_EQ(assembly.instances.size(), 5u);
    EXPECT_EQ(assembly.triangles.size() * 5, assembly.shown);
    expect_ordered(assembly);
    expect_whole(build.scene, at_rest(build.scene), assembly, 1e-5);
}

TEST(Assembly, SmallMeshesAreSharedWhereThereAreManyOrWhereTheyMove) {
    Builder few, many, moving;
    const int a = few.mesh(box({0, 0, 0}, {1, 1, 1})), b = many.mesh(box({0, 0, 0}, {1, 1, 1})),
              c = moving.mesh(box({0, 0, 0}, {1, 1, 1}));
    for (int i = 0; i < 6; i++) few.node(a, {2.0f * float(i), 0, 0});
    for (int i = 0; i < 2000; i++) many.node(b, {2.0f * float(i), 0, 0});
    for (int i = 0; i < 6; i++) moving.turn(moving.node(c, {2.0f * float(i), 0, 0}));
    EXPECT_EQ(few.take_apart().instances.size(), 1u);
    EXPECT_EQ(many.take_apart().instances.size(), 2000u);
    EXPECT_EQ(many.take_apart().bodies.size(), 1u);
    const Assembly assembly = moving.take_apart();
    EXPECT_EQ(assembly.instances.size(), 6u);
    EXPECT_EQ(assembly.bodies.size(), 1u);
    expect_whole(moving.scene, moment_of(moving.scene, "0", 0.7), assembly, 1e-5);
}

TEST(Assembly, SkinsDeformWhileAJointMoves) {
    Builder build;
    Primitive shape = sphere({0, 0, 0}, 1, 4);
    JointWeights weights;
    weights.weights[0] = 1;
    shape.joints.assign(shape.positions.size(), weights);
    const int skinned = build.node(build.mesh(shape)), joint = build.node(-1, {0, 1, 0});
    build.scene.nodes[size_t(skinned)].skin = 0;
    build.scene.skins.push_back({"skin", {joint}, {glm::mat4(1)}});
    build.node(build.mesh(torus({0, 0, 0}, 1, 0.3f, 12, 8)), {0, 4, 0});
    EXPECT_TRUE(build.take_apart().pieces.empty()) << "nothing moves";
    build.turn(joint);
    const Assembly assembly = build.take_apart();
    EXPECT_EQ(assembly.fixed, 1u);
    ASSERT_EQ(assembly.pieces.size(), 1u);
    EXPECT_EQ(assembly.bodies[1].triangles, shape.triangles.size());
    EXPECT_TRUE(assemble(build.scene, at_rest(build.scene), motion_of(build.scene, "")).pieces.empty())
        << "without the animation";
}

TEST(Assembly, WeightsThatChangeAreADeformation) {
    Builder build;
    Primitive shape = sphere({0, 0, 0}, 1, 4);
    shape.targets.push_back({std::vector<vec3>(shape.positions.size(), vec3(0, 1, 0)), {}});
    const int mesh = build.mesh(shape), one = build.node(mesh), other = build.node(mesh, {5, 0, 0});
    (void)other;
    build.animate(one, Path::weights, {0, 1});
    const Assembly assembly = build.take_apart();
    ASSERT_EQ(assembly.pieces.size(), 1u);
    EXPECT_EQ(assembly.pieces[0].node, one);
    EXPECT_EQ(assembly.fixed, 1u);
}

TEST(Assembly, UnknownAnimationsAreRefused) {
    Builder build;
    build.turn(build.node(build.mesh(sphere({0, 0, 0}, 1, 4))));
    EXPECT_THROW(build.take_apart("7"), Error);
}

TEST(Assembly, OfBuiltInScenesIsTheScene) {
    for (const char* name : {"builtin:teapots", "builtin:glass", "builtin:tree", "builtin:blob:5000"}) {
        SCOPED_TRACE(name);
        const Scene scene = load_scene(name);
        const Assembly assembly = assemble(scene, at_rest(scene), motion_of(scene, ""));
        expect_ordered(assembly);
        expect_whole(scene, at_rest(scene), assembly, 1e-5);
        EXPECT_EQ(assembly.fixed, assembly.bodies.size());
        EXPECT_LE(assembly.bodies.size(), 6u) << "what lies together stays together";
    }
}

TEST(Assembly, OfModelsIsTheScene) {
    const std::string folder = PEELRAY_MODELS;
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << "the test models are not here: " << folder;
    size_t compared = 0;
    for (const char* part : {"/skinned", "/gltf"})
        for (const auto& entry : std::filesystem::recursive_directory_iterator(folder + part)) {
            const std::string extension = entry.path().extension();
            if (extension != ".glb" && extension != ".gltf") continue;
            SCOPED_TRACE(entry.path().filename());
            Scene scene;
            try {
                scene = load_scene(entry.path());
            } catch (const Error&) {
                continue;
            }
            const std::string which = scene.animations.empty() ? "" : "all";
            const Assembly assembly = assemble(scene, at_rest(scene), motion_of(scene, which));
            expect_ordered(assembly);
            // What is not animated looks alike in every moment.
            const std::vector<double> times =
                which.empty() ? std::vector<double>{0.0} : std::vector<double>{0.0, 0.4, 1.1};
            for (const double time : times) {
                const Moment moment = moment_of(scene, which, time);
                const Geometry geometry = flatten(scene, moment);
                expect_whole(scene, moment, assembly, 1e-5 * glm::length(geometry.upper - geometry.lower) + 1e-6);
                if (::testing::Test::HasFatalFailure()) return;
            }
            compared++;
        }
    EXPECT_GT(compared, 40u);
}

// --- Grouping ---

Part cube_part(const vec3& at, float size, uint64_t triangles) {
    return {at - vec3(size / 2), at + vec3(size / 2), triangles, 6.0 * size * size};
}

TEST(Grouping, AGroundDoesNotCoarsenWhatStandsOnIt) {
    std::vector<Part> parts = {cube_part({0, 1, 0}, 2, 100'000),
                               {vec3(-50, 0, -50), vec3(50, 0, 50), 2, 1e4},
                               cube_part({2.5f, 1, 0}, 2, 100'000)};
    const auto groups = group_parts(parts);
    ASSERT_EQ(groups.size(), 2u);
    EXPECT_EQ(groups[0], (std::vector<uint32_t>{0, 2}));
    EXPECT_EQ(groups[1], std::vector<uint32_t>{1});
}

TEST(Grouping, ATownFallsIntoQuarters) {
    std::vector<Part> parts;
    for (int x = 0; x < 16; x++)
        for (int z = 0; z < 16; z++) parts.push_back(cube_part({60 * x, 0, 60 * z}, 8, 200'000));
    const auto groups = group_parts(parts);
    EXPECT_GT(groups.size(), 4u);
    EXPECT_LE(groups.size(), 256u);
    size_t count = 0;
    for (const auto& group : groups) count += group.size();
    EXPECT_EQ(count, parts.size());
}

TEST(Grouping, PartsInOnePlaceStayTogether) {
    std::vector<Part> parts;
    for (int i = 0; i < 30; i++) parts.push_back(cube_part({0.02f * float(i), 0, 0}, 1, 3000));
    EXPECT_EQ(group_parts(parts).size(), 1u);
    EXPECT_TRUE(group_parts({}).empty());
    EXPECT_EQ(group_parts({cube_part({0, 0, 0}, 0, 0)}).size(), 1u) << "a point";
}

}  // namespace
}  // namespace peelray
