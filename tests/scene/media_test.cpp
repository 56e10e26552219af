// Which medium counts where two overlap, and whether any may.
#include <gtest/gtest.h>

#include "builtin/shapes.h"
#include "scene/media.h"

namespace peelray {
namespace {

Material volume() {
    Material m;
    m.transmission = 1;
    m.thickness = 1;
    return m;
}

/// A node for each shape, each with its own material.
Scene scene_of(const std::vector<Primitive>& shapes) {
    Scene scene;
    for (Primitive shape : shapes) {
        shape.material = uint32_t(scene.materials.size());
        scene.materials.push_back(volume());
        Node node;
        node.mesh = int(scene.meshes.size());
        scene.meshes.push_back({"shape", {std::move(shape)}});
        scene.nodes.push_back(node);
    }
    return scene;
}

bool may_overlap(const Scene& scene) {
    return MediaPieces(scene).may_overlap(scene, at_rest(scene));
}

using Order = std::vector<uint32_t>;

TEST(Media, TheSmallerVolumeComesFirst) {
    EXPECT_EQ(media_ranks(scene_of({box({0, 0, 0}, {2, 2, 2}), box({5, 5, 5}, {6, 6, 6})})).materials, (Order{1, 0}));
    EXPECT_EQ(media_ranks(scene_of({box({5, 5, 5}, {6, 6, 6}), box({0, 0, 0}, {2, 2, 2})})).materials, (Order{0, 1}));
    EXPECT_EQ(media_ranks(scene_of({box({0, 0, 0}, {1, 1, 1}), box({3, 0, 0}, {4, 1, 1})})).materials, (Order{0, 1}));
}

TEST(Media, NodesScaleVolumes) {
    Scene scene = scene_of({box({0, 0, 0}, {2, 2, 2}), box({0, 0, 0}, {1, 1, 1})});
    scene.nodes[1].local = glm::mat4(glm::mat3(-3));
    scene.nodes[1].local[3][3] = 1;
    EXPECT_EQ(media_ranks(scene).materials, (Order{0, 1}));
}

TEST(Media, AShellIsSmallerThanWhatFillsIt) {
    // Two primitives of one material in one mesh: the outer and, turned inside out, the inner wall.
    Scene scene = scene_of({box({-1, -1, -1}, {1, 1, 1}), box({-0.9f, -0.9f, -0.9f}, {0.9f, 0.9f, 0.9f})});
    Primitive inner = box({-0.9f, -0.9f, -0.9f}, {0.9f, 0.9f, 0.9f});
    for (glm::uvec3& t : inner.triangles) std::swap(t.y, t.z);
    scene.meshes[0].primitives.push_back(inner);
    EXPECT_EQ(media_ranks(scene).materials, (Order{0, 1}));
    scene.meshes[0].primitives.pop_back();
    EXPECT_EQ(media_ranks(scene).materials, (Order{1, 0}));
}

TEST(Media, WhatIsOpenComesLast) {
    const Scene scene = scene_of({parallelogram({0, 0, 0}, {0.1f, 0, 0}, {0, 0, 0.1f}), box({0, 0, 0}, {9, 9, 9})});
    EXPECT_EQ(media_ranks(scene).materials, (Order{1, 0}));
}

TEST(Media, OnlyVolumesHaveRanks) {
    Scene scene = scene_of(
        {box({0, 0, 0}, {1, 1, 1}), box({0, 0, 0}, {1, 1, 1}), box({0, 0, 0}, {1, 1, 1}), box({0, 0, 0}, {1, 1, 1})});
    scene.materials[0].thickness = 0;
    scene.materials[1].metallic = 1;
    scene.materials[2].unlit = true;
    const MediaRanks ranks = media_ranks(scene);
    EXPECT_EQ(ranks.materials, Order{3});
    EXPECT_EQ(ranks.of_material, (Order{MediaRanks::none, MediaRanks::none, MediaRanks::none, 0}));
    EXPECT_FALSE(may_overlap(scene));
}

TEST(Media, PiecesThatMeetMayOverlap) {
    EXPECT_FALSE(may_overlap(scene_of({box({0, 0, 0}, {1, 1, 1})})));
    EXPECT_FALSE(may_overlap(scene_of({box({0, 0, 0}, {1, 1, 1}), box({1.1f, 0, 0}, {2, 1, 1})})));
    EXPECT_TRUE(may_overlap(scene_of({box({0, 0, 0}, {1, 1, 1}), box({1, 0, 0}, {2, 1, 1})})));
    EXPECT_TRUE(may_overlap(scene_of({box({0, 0, 0}, {3, 3, 3}), box({1, 1, 1}, {2, 2, 2})})));
    Scene moved = scene_of({box({0, 0, 0}, {1, 1, 1}), box({1.1f, 0, 0}, {2, 1, 1})});
    Moment moment = at_rest(moved);
    moment.worlds[1][3].x = -0.5f;
    EXPECT_TRUE(MediaPieces(moved).may_overlap(moved, moment));
}

TEST(Media, PiecesOfOnePrimitiveCount) {
    // Two boxes in one primitive, apart and into each other.
    for (const float x : {1.5f, 0.5f}) {
        Scene scene = scene_of({box({0, 0, 0}, {1, 1, 1})});
        Primitive& both = scene.meshes[0].primitives[0];
        const Primitive other = box({x, 0.2f, 0.2f}, {x + 1, 0.8f, 0.8f});
        const auto offset = uint32_t(both.positions.size());
        both.positions.insert(both.positions.end(), other.positions.begin(), other.positions.end());
        both.normals.insert(both.normals.end(), other.normals.begin(), other.normals.end());
        for (const glm::uvec3& t : other.triangles) both.triangles.push_back(t + offset);
        EXPECT_EQ(may_overlap(scene), x < 1) << x;
    }
}

TEST(Media, AroundAPoint) {
    Scene scene = scene_of({box({0, 0, 0}, {4, 4, 4}), box({1, 1, 1}, {3, 3, 3}), box({0, 0, 0}, {1, 1, 1})});
    // A hollow in the first, and the third turned, mirrored and moved to [5, 7]³.
    Primitive hollow = box({0.25f, 0.25f, 0.25f}, {0.75f, 0.75f, 0.75f});
    for (glm::uvec3& t : hollow.triangles) std::swap(t.y, t.z);
    scene.meshes[0].primitives.push_back(hollow);
    scene.nodes[2].local = glm::mat4(0, 2, 0, 0, 2, 0, 0, 0, 0, 0, -2, 0, 5, 5, 7, 1);
    const MediaPieces pieces(scene);
    const Moment rest = at_rest(scene);
    EXPECT_EQ(pieces.around(scene, rest, {2, 2, 2}), (Order{0, 1}));
    EXPECT_EQ(pieces.around(scene, rest, {3.5, 2, 2}), (Order{0}));
    EXPECT_EQ(pieces.around(scene, rest, {0.5, 0.5, 0.5}), (Order{}));
    EXPECT_EQ(pieces.around(scene, rest, {4.5, 2, 2}), (Order{}));
    EXPECT_EQ(pieces.around(scene, rest, {5.5, 6.5, 5.5}), (Order{2}));
}

}  // namespace
}  // namespace peelray
