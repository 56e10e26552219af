// Points and lines as balls and tubes.
#include "scene/thicken.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace peelray {
namespace {

/// Positive where the triangles face outwards.
double volume(const Primitive& p) {
    double sum = 0;
    for (const glm::uvec3& t : p.triangles) {
        const glm::dvec3 a = p.positions[t.x], b = p.positions[t.y], c = p.positions[t.z];
        sum += glm::dot(a, glm::cross(b, c)) / 6;
    }
    return sum;
}

double distance_to_segment(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b) {
    const double t = std::clamp(glm::dot(p - a, b - a) / glm::dot(b - a, b - a), 0.0, 1.0);
    return glm::distance(p, a + t * (b - a));
}

Primitive three_points() {
    Primitive p;
    p.positions = {{0, 0, 0}, {4, 0, 0}, {4, 0, 3}};
    p.colors = {{1, 0, 0, 1}, {0, 1, 0, 1}, {0, 0, 1, 1}};
    p.uvs = {{0, 0}, {1, 0}, {1, 1}};
    return p;
}

TEST(Thicken, PointsBecomeBallsOfTheirColor) {
    Primitive p = three_points();
    const std::vector<uint32_t> corners = {2, 0, 2};
    thicken(p, corners, LineMode::points, 0.5f);
    ASSERT_EQ(p.triangles.size(), 40u);  // a point that is named twice is one ball
    EXPECT_LE(p.triangles.size(), thickened_triangles(corners.size(), LineMode::points));
    ASSERT_EQ(p.positions.size(), 24u);
    ASSERT_EQ(p.normals.size(), 24u);
    ASSERT_EQ(p.colors.size(), 24u);
    for (size_t i = 0; i < 24; ++i) {
        const glm::vec3 point = i < 12 ? glm::vec3(4, 0, 3) : glm::vec3(0);
        EXPECT_NEAR(glm::distance(p.positions[i], point), 0.5, 1e-6);
        EXPECT_LT(glm::distance(p.positions[i], point + 0.5f * p.normals[i]), 1e-6);
        EXPECT_EQ(p.colors[i], i < 12 ? glm::vec4(0, 0, 1, 1) : glm::vec4(1, 0, 0, 1));
        EXPECT_EQ(p.uvs[i], i < 12 ? glm::vec2(1, 1) : glm::vec2(0, 0));
    }
    // An icosahedron of radius r has the volume 2.536 r³.
    EXPECT_NEAR(volume(p), 2 * 2.5362 * 0.125, 1e-3);
    for (const glm::uvec3& t : p.triangles) {
        const glm::vec3 n = glm::cross(p.positions[t.y] - p.positions[t.x], p.positions[t.z] - p.positions[t.x]);
        for (int k = 0; k < 3; ++k) EXPECT_GT(glm::dot(n, p.normals[t[k]]), 0.f);
    }
}

TEST(Thicken, LinesOfEveryModeConnectTheirPoints) {
    struct Case {
        LineMode mode;
        std::vector<uint32_t> corners;
        size_t balls, tubes;
    };
    for (const Case& c : {Case{LineMode::lines, {0, 1, 1, 2, 0}, 3, 2}, Case{LineMode::strip, {0, 1, 2}, 3, 2},
                          Case{LineMode::loop, {0, 1, 2}, 3, 3}, Case{LineMode::loop, {0, 1}, 2, 1},
                          Case{LineMode::lines, {1, 1}, 1, 0}, Case{LineMode::strip, {}, 0, 0}}) {
        Primitive p = three_points();
        thicken(p, c.corners, c.mode, 0.1f);
        EXPECT_EQ(p.triangles.size(), 20 * c.balls + 12 * c.tubes);
        EXPECT_LE(p.triangles.size(), thickened_triangles(c.corners.size(), c.mode));
        for (const glm::vec3& at : p.positions) {
            const double nearest =
                std::min({distance_to_segment(at, {0, 0, 0}, {4, 0, 0}), distance_to_segment(at, {4, 0, 0}, {4, 0, 3}),
                          distance_to_segment(at, {4, 0, 3}, {0, 0, 0})});
            EXPECT_LT(nearest, 0.1 + 1e-5);
        }
        // The tubes' sides: each has the line's length and the hexagon's circumference, 6 r.
        double area = 0;
        for (size_t i = 20 * c.balls; i < p.triangles.size(); ++i) {
            const glm::uvec3 t = p.triangles[i];
            const glm::dvec3 n = glm::cross(glm::dvec3(p.positions[t.y] - p.positions[t.x]),
                                            glm::dvec3(p.positions[t.z] - p.positions[t.x]));
            area += glm::length(n) / 2;
            EXPECT_GT(glm::dot(n, glm::dvec3(p.normals[t.x])), 0);
        }
        if (c.mode == LineMode::loop && c.tubes == 3) {
            EXPECT_NEAR(area, 12 * 0.6, 1e-4);
        }
    }
}

TEST(Thicken, JointsAndTargetsGoWithTheirPoint) {
    Primitive p = three_points();
    p.joints.resize(3);
    p.joints[2].joints[0] = 7;
    p.targets.push_back({{{0, 0, 0}, {0, 0, 0}, {0, 9, 0}}, {{1, 0, 0}, {1, 0, 0}, {1, 0, 0}}});
    thicken(p, std::vector<uint32_t>{1, 2}, LineMode::points, 1);
    ASSERT_EQ(p.joints.size(), 24u);
    EXPECT_EQ(p.joints[0].joints[0], 0);
    EXPECT_EQ(p.joints[23].joints[0], 7);
    ASSERT_EQ(p.targets[0].positions.size(), 24u);
    EXPECT_EQ(p.targets[0].positions[23], glm::vec3(0, 9, 0));
    EXPECT_TRUE(p.targets[0].normals.empty());
}

}  // namespace
}  // namespace peelray
