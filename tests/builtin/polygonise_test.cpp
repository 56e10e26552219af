// Meshes of implicit surfaces: closed, even, on the surface, cut along lines; joint weights that flow over them.
#include "builtin/polygonise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "builtin/parted_mesh.h"
#include "builtin/shapes.h"
#include "builtin/skin_weights.h"
#include "builtin/soft_body.h"

namespace peelray {
namespace {

using glm::vec3;

float ball_field(const vec3& p) {
    return glm::length(p) - 1;
}

float ring_field(const vec3& p) {
    return glm::length(glm::vec2(glm::length(glm::vec2(p.x, p.z)) - 1, p.y)) - 0.3f;
}

/// V - E + F; a test failure where an edge is not shared by two triangles in opposite directions.
int euler_number(const std::vector<glm::uvec3>& triangles) {
    std::map<std::pair<uint32_t, uint32_t>, int> edges;
    std::set<uint32_t> vertices;
    for (const glm::uvec3& t : triangles)
        for (int k = 0; k < 3; ++k) {
            ++edges[{t[k], t[(k + 1) % 3]}];
            vertices.insert(t[k]);
        }
    size_t open = 0;
    for (const auto& [edge, count] : edges) open += count != 1 || edges.count({edge.second, edge.first}) == 0;
    EXPECT_EQ(open, 0u);
    return int(vertices.size()) - int(edges.size() / 2) + int(triangles.size());
}

double volume(const std::vector<vec3>& positions, const std::vector<glm::uvec3>& triangles) {
    double sum = 0;
    for (const glm::uvec3& t : triangles)
        sum += glm::dot(glm::dvec3(positions[t.x]), glm::cross(glm::dvec3(positions[t.y]), glm::dvec3(positions[t.z])));
    return sum / 6;
}

TEST(Polygonise, BallAndRingAreClosedAndOutwards) {
    ClosedMesh ball = polygonise(ball_field, vec3(-1.3f), vec3(1.3f), 0.1f);
    const std::vector<glm::uvec3> of_ball = ball.compact();
    EXPECT_EQ(euler_number(of_ball), 2);
    EXPECT_NEAR(volume(ball.positions, of_ball), 4 * M_PI / 3, 0.05);
    ClosedMesh ring = polygonise(ring_field, {-1.5f, -0.5f, -1.5f}, {1.5f, 0.5f, 1.5f}, 0.07f);
    const std::vector<glm::uvec3> of_ring = ring.compact();
    EXPECT_EQ(euler_number(of_ring), 0);
    EXPECT_NEAR(volume(ring.positions, of_ring), 2 * M_PI * M_PI * 0.09, 0.05);
}

TEST(Polygonise, RemeshedTrianglesAreEvenAndOnTheSurface) {
    ClosedMesh mesh = polygonise(ring_field, {-1.5f, -0.5f, -1.5f}, {1.5f, 0.5f, 1.5f}, 0.07f);
    remesh(
        mesh, ring_field, [](const vec3& p) { return p.x > 0 ? 0.05f : 0.1f; }, 4);
    const std::vector<glm::uvec3> triangles = mesh.compact();
    EXPECT_EQ(euler_number(triangles), 0);
    for (const vec3& p : mesh.positions) ASSERT_NEAR(ring_field(p), 0, 2e-3f);
    size_t uneven = 0, sharp = 0;
    for (const glm::uvec3& t : triangles)
        for (int k = 0; k < 3; ++k) {
            const vec3 &a = mesh.positions[t[k]], &b = mesh.positions[t[(k + 1) % 3]],
                       &c = mesh.positions[t[(k + 2) % 3]];
            const float wanted = 0.5f * (a.x + b.x) > 0 ? 0.05f : 0.1f, length = glm::distance(a, b);
            uneven += std::abs(a.x + b.x) > 0.3f && (length < 0.6f * wanted || length > 1.5f * wanted);
            sharp += glm::dot(glm::normalize(b - a), glm::normalize(c - a)) > std::cos(glm::radians(28.f));
        }
    EXPECT_LT(uneven, triangles.size() / 100);
    EXPECT_LT(sharp, triangles.size() / 200);
}

TEST(ClosedMesh, StaysClosedWhateverIsDone) {
    ClosedMesh mesh = polygonise(ball_field, vec3(-1.3f), vec3(1.3f), 0.2f);
    Random random(3);
    int split = 0, collapsed = 0, turned = 0;
    for (int i = 0; i < 6000; ++i) {
        const auto h = uint32_t(random.next() * float(mesh.half_edges()));
        if (mesh.is_dead(h)) continue;
        ASSERT_EQ(mesh.twin(mesh.twin(h)), h);
        ASSERT_EQ(mesh.from(mesh.twin(h)), mesh.to(h));
        const vec3 middle = glm::normalize(mesh.positions[mesh.from(h)] + mesh.positions[mesh.to(h)]);
        const float which = random.next();
        if (which < 0.2f)
            mesh.split(h, middle), ++split;
        else if (which < 0.7f)
            collapsed += mesh.collapse(h, middle, 1);
        else
            turned += mesh.turn(h);
    }
    EXPECT_GT(split, 500);
    EXPECT_GT(collapsed, 500);
    EXPECT_GT(turned, 300);
    const std::vector<glm::uvec3> triangles = mesh.compact();
    EXPECT_EQ(euler_number(triangles), 2);
    EXPECT_GT(volume(mesh.positions, triangles), 3);
}

TEST(PartedMesh, IsCutAlongItsLines) {
    ClosedMesh mesh = polygonise(ball_field, vec3(-1.3f), vec3(1.3f), 0.1f);
    remesh(
        mesh, ball_field, [](const vec3&) { return 0.1f; }, 3);
    PartedMesh parted(std::move(mesh), ball_field);
    const Field north = [](const vec3&p) { return 0.3f - p.y; }, east = [](const vec3&p) { return 0.1f - p.x; };
    parted.give(0, 1, north);
    parted.give(1, 2, east);
    parted.improve(0.01f);
    const ClosedMesh& cut = parted.mesh();
    std::vector<glm::uvec3> triangles;
    std::vector<size_t> counts(3);
    for (uint32_t t = 0; t < parted.parts().size(); ++t) {
        triangles.push_back({cut.from(3 * t), cut.from(3 * t + 1), cut.from(3 * t + 2)});
        const uint32_t part = parted.parts()[t];
        ++counts.at(part);
        for (int k = 0; k < 3; ++k) {
            const vec3& p = cut.positions[triangles.back()[k]];
            ASSERT_NEAR(glm::length(p), 1, 2e-3f);
            if (part == 0) {
                ASSERT_LT(p.y, 0.3f + 2e-3f);
            }
            if (part > 0) {
                ASSERT_GT(p.y, 0.3f - 2e-3f);
            }
            if (part == 1) {
                ASSERT_LT(p.x, 0.1f + 2e-3f);
            }
            if (part == 2) {
                ASSERT_GT(p.x, 0.1f - 2e-3f);
            }
        }
    }
    EXPECT_EQ(euler_number(triangles), 2);
    for (const size_t count : counts) EXPECT_GT(count, 100u);
}

TEST(SoftBody, NeverClaimsToBeFartherAwayThanItIs) {
    SoftGroup group;
    group.pieces = {cone({0, 0, 0}, 0.3f, {1, 0.2f, 0}, 0.15f), ball({0.5f, 0.5f, 0}, 0.25f, {1, 1, 1.4f}),
                    ring({0, 0.6f, 0}, {0, 1, 0.3f}, 0.4f, 0.1f)};
    group.cuts.push_back({{0, -1, 0}, 0.1f, 0.02f});
    group.measure();
    SoftBody body;
    body.groups = {group};
    Random random(5);
    const auto anywhere = [&] { return vec3(random.between(-1, 2), random.between(-1, 2), random.between(-1, 1)); };
    for (int i = 0; i < 20000; ++i) {
        const vec3 a = anywhere(), b = a + 0.2f * anywhere();
        // No steeper than 1, so that the value bounds the distance.
        ASSERT_LE(std::abs(body.at(a) - body.at(b)), 1.001f * glm::distance(a, b) + 1e-5f);
        ASSERT_LE(group.at_least(a), std::max(group.at(a), 0.f) + 1e-5f);
    }
    EXPECT_LT(body.at({0.2f, 0.1f, 0}), 0);
    EXPECT_GT(body.at({0.2f, -0.2f, 0}), 0);  // cut off
}

TEST(SkinWeights, FlowAlongAndNeverAcrossAGap) {
    // A U of two arms with a bone each: nothing of one may pull at the other's far end.
    const SoftGroup arms = [] {
        SoftGroup group;
        group.pieces = {cone({-0.2f, 0, 0}, 0.12f, {-0.2f, 1, 0}, 0.12f),
                        cone({0.2f, 0, 0}, 0.12f, {0.2f, 1, 0}, 0.12f),
                        cone({-0.2f, 0, 0}, 0.12f, {0.2f, 0, 0}, 0.12f)};
        for (Piece& piece : group.pieces) piece.blend = 0.02f;
        group.measure();
        return group;
    }();
    const Field field = [&](const vec3& p) { return arms.at(p); };
    ClosedMesh mesh = polygonise(field, {-0.5f, -0.3f, -0.3f}, {0.5f, 1.3f, 0.3f}, 0.04f);
    remesh(
        mesh, field, [](const vec3&) { return 0.04f; }, 3);
    const std::vector<Bone> bones = {{0, {-0.2f, 0, 0}, {-0.2f, 1, 0}, 0.12f}, {1, {0.2f, 0, 0}, {0.2f, 1, 0}, 0.12f}};
    const std::vector<JointWeights> weights = soft_weights(mesh, bones, 2, [](const vec3&) { return 0.1f; });
    ASSERT_EQ(weights.size(), mesh.positions.size());
    for (size_t i = 0; i < weights.size(); ++i) {
        float of_right = 0, sum = 0;
        for (size_t k = 0; k < weights[i].weights.size(); ++k) {
            sum += weights[i].weights[k];
            if (weights[i].joints[k] == 1) of_right += weights[i].weights[k];
        }
        const vec3& p = mesh.positions[i];
        ASSERT_NEAR(sum, 1, 1e-5f);
        if (p.y > 0.6f) {
            EXPECT_FLOAT_EQ(of_right, p.x > 0 ? 1.f : 0.f);
        }
        if (std::abs(p.x) < 0.02f) {
            EXPECT_NEAR(of_right, 0.5f, 0.35f);
        }
    }
}

}  // namespace
}  // namespace peelray
