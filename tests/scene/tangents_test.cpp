// Tangents where a file has none.
#include "scene/tangents.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "builtin/shapes.h"

namespace peelray {
namespace {

Primitive flat_triangles(const std::vector<glm::vec3>& positions, const std::vector<glm::uvec3>& triangles,
                         const std::vector<glm::vec2>& uvs) {
    Primitive p;
    p.positions = positions;
    p.normals.assign(positions.size(), {0, 0, 1});
    p.uvs = uvs;
    p.triangles = triangles;
    return p;
}

void expect_tangent(const glm::vec4& got, const glm::vec4& want) {
    for (int i = 0; i < 4; i++) EXPECT_NEAR(got[i], want[i], 1e-6) << i;
}

const std::vector<glm::vec3> kSquare = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};

TEST(TangentsTest, RunAlongUAndTheSideIsThatOfTheFirstRow) {
    Primitive p = flat_triangles(kSquare, {{0, 1, 2}, {0, 2, 3}}, {{0, 1}, {1, 1}, {1, 0}, {0, 0}});
    make_tangents(p, p.uvs);
    ASSERT_EQ(p.tangents.size(), 4u);
    for (const glm::vec4& t : p.tangents) expect_tangent(t, {1, 0, 0, 1});
    p = flat_triangles(kSquare, {{0, 1, 2}, {0, 2, 3}}, {{1, 1}, {0, 1}, {0, 0}, {1, 0}});  // mirrored
    make_tangents(p, p.uvs);
    for (const glm::vec4& t : p.tangents) expect_tangent(t, {-1, 0, 0, -1});
}

TEST(TangentsTest, AVertexBetweenAMirroredAndAPlainHalfIsSplit) {
    // Two squares side by side whose textures run away from the common edge.
    Primitive p =
        flat_triangles({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {-1, 1, 0}, {-1, 0, 0}},
                       {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}}, {{0, 1}, {1, 1}, {1, 0}, {0, 0}, {1, 0}, {1, 1}});
    p.colors.assign(6, glm::vec4(0.25f));
    p.targets.resize(1);
    for (const glm::vec3& position : p.positions) p.targets[0].positions.push_back(2.f * position);
    const std::vector<glm::vec3> before = p.positions;
    std::vector<glm::vec3> corners;
    for (const glm::uvec3& t : p.triangles)
        for (int k = 0; k < 3; k++) corners.push_back(p.positions[t[k]]);
    make_tangents(p, p.uvs);
    EXPECT_EQ(p.positions.size(), 8u);
    EXPECT_EQ(p.tangents.size(), 8u);
    EXPECT_EQ(p.colors.size(), 8u);
    ASSERT_EQ(p.triangles.size(), 4u);
    for (size_t i = 0; i < corners.size(); i++) {
        const uint32_t vertex = p.triangles[i / 3][int(i % 3)];
        EXPECT_EQ(p.positions[vertex], corners[i]) << i;
        EXPECT_EQ(p.targets[0].positions[vertex], 2.f * corners[i]) << i;
        expect_tangent(p.tangents[vertex], i < 6 ? glm::vec4(1, 0, 0, 1) : glm::vec4(-1, 0, 0, -1));
    }
    for (size_t i = 0; i < before.size(); i++) EXPECT_EQ(p.positions[i], before[i]) << i;
}

TEST(TangentsTest, CornersWeighByTheirAngle) {
    // At the origin a corner of 90 degrees whose u runs along (1, 0), and one of 45 degrees whose u runs along (1, -1).
    Primitive p = flat_triangles({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 1, 0}}, {{0, 1, 2}, {0, 2, 3}},
                                 {{0, 0}, {1, 0}, {0, -1}, {-1, 0}});
    make_tangents(p, p.uvs);
    const glm::dvec2 sum = glm::normalize(glm::dvec2(2, 0) + glm::normalize(glm::dvec2(1, -1)));
    expect_tangent(p.tangents[0], glm::vec4(float(sum.x), float(sum.y), 0, 1));
}

TEST(TangentsTest, ATriangleWithoutTextureAreaTakesThoseAroundIt) {
    Primitive p =
        flat_triangles({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 0, 0}},
                       {{0, 1, 2}, {0, 2, 3}, {1, 4, 2}, {0, 0, 3}}, {{0, 1}, {1, 1}, {1, 0}, {0, 0}, {1, 1}});
    make_tangents(p, p.uvs);
    EXPECT_EQ(p.positions.size(), 5u);
    for (const uint32_t vertex : {0u, 1u, 2u, 3u}) expect_tangent(p.tangents[vertex], {1, 0, 0, 1});
    EXPECT_EQ(p.tangents[4].w, 0);  // of a corner that touches nothing else: none, the normal stays
}

TEST(TangentsTest, OppositeTexturesDoNotMix) {
    // Half a turn of triangles around the origin, a whole turn of their texture: u runs along (1, 0) in the first,
    // along (0, -1) in the second and against the first in the third.
    const float h = std::sqrt(0.75f), r = std::sqrt(0.5f);
    Primitive p = flat_triangles({{0, 0, 0}, {1, 0, 0}, {0.5f, h, 0}, {-0.5f, h, 0}, {-1, 0, 0}},
                                 {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}}, {{0, 0}, {1, 0}, {-0.5f, -h}, {-0.5f, h}, {1, 0}});
    make_tangents(p, p.uvs);
    expect_tangent(p.tangents[p.triangles[0].x], {r, -r, 0, 1});
    expect_tangent(p.tangents[p.triangles[1].x], {0, -1, 0, 1});
    expect_tangent(p.tangents[p.triangles[2].x], {-r, -r, 0, 1});
}

TEST(TangentsTest, OnASphereTheyAreEastAndUnit) {
    Primitive ball = sphere({0, 0, 0}, 1, 24);
    ball.uvs.clear();
    for (const glm::vec3& p : ball.positions)  // the seam lies at -x; v downwards from the pole
        ball.uvs.push_back({float(std::atan2(double(-p.z), double(p.x)) / 6.2831853),
                            float(std::acos(std::clamp(p.y, -1.f, 1.f)) / 3.14159265f)});
    make_tangents(ball, ball.uvs);
    size_t compared = 0;
    for (size_t i = 0; i < ball.positions.size(); i++) {
        const glm::vec3 p = ball.positions[i];
        if (std::abs(p.y) > 0.9f || p.x < -0.3f) continue;
        const glm::vec3 east = glm::normalize(glm::vec3(p.z, 0, -p.x));
        EXPECT_GT(glm::dot(glm::vec3(ball.tangents[i]), east), 0.99f) << i;
        EXPECT_NEAR(glm::dot(glm::vec3(ball.tangents[i]), ball.normals[i]), 0, 1e-5) << i;
        EXPECT_EQ(ball.tangents[i].w, 1) << i;
        compared++;
    }
    EXPECT_GT(compared, 100u);
}

TEST(TangentsTest, OnlyMaterialsThatBendNormalsGetThem) {
    Scene scene;
    scene.materials.resize(2);
    scene.materials[1].normal_texture = 0;
    scene.materials[1].normal_texture.uv_matrix = glm::mat2(0, 1, -1, 0);  // the texture turned by a quarter
    scene.textures.resize(1);
    Primitive p = flat_triangles(kSquare, {{0, 1, 2}, {0, 2, 3}}, {{0, 1}, {1, 1}, {1, 0}, {0, 0}});
    scene.meshes.push_back({"", {p, p}, {}});
    scene.meshes[0].primitives[1].material = 1;
    complete_tangents(scene);
    EXPECT_TRUE(scene.meshes[0].primitives[0].tangents.empty());
    // The texture's u is -v, which rises with y; its v is u, so that its first row lies towards -x.
    for (const glm::vec4& t : scene.meshes[0].primitives[1].tangents) expect_tangent(t, {0, 1, 0, 1});
}

}  // namespace
}  // namespace peelray
