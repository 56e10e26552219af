#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "loaders/scene_files.h"

namespace peelray::testing {
namespace {

Primitive triangle(float x) {
    Primitive p;
    p.positions = {{x, 0, 0}, {x + 1, 0, 0}, {x, 1, 0}};
    p.normals.assign(3, {0, 0, 1});
    p.triangles = {{0, 1, 2}};
    return p;
}

Scene two_nodes() {
    Scene scene;
    scene.name = "two";
    scene.materials.resize(2);
    scene.meshes.resize(1);
    scene.meshes[0].primitives = {triangle(0), triangle(10)};
    scene.meshes[0].primitives[1].material = 1;
    scene.nodes.resize(2);
    scene.nodes[0].mesh = scene.nodes[1].mesh = 0;
    scene.nodes[1].parent = 0;
    scene.nodes[1].local = glm::translate(glm::mat4(1), {0, 0, 5});
    return scene;
}

TEST(Flatten, OrderMaterialsBounds) {
    const Geometry g = flatten(two_nodes());
    ASSERT_EQ(g.triangles.size(), 4u);
    EXPECT_EQ(g.materials, (std::vector<uint32_t>{0, 1, 0, 1}));
    EXPECT_EQ(g.positions[g.triangles[3].x], glm::vec3(10, 0, 5));
    EXPECT_EQ(g.lower, glm::vec3(0, 0, 0));
    EXPECT_EQ(g.upper, glm::vec3(11, 1, 5));
    EXPECT_EQ(g.uvs.size(), g.positions.size());
    EXPECT_TRUE(g.colors.empty());
    EXPECT_EQ(g.zero_area, 0u);
}

TEST(Flatten, BoundsCoverReferencedPositionsOnly) {
    Scene scene = two_nodes();
    scene.meshes[0].primitives[0].positions.push_back({99, 99, 99});
    scene.meshes[0].primitives[0].normals.push_back({0, 0, 1});
    EXPECT_EQ(flatten(scene).upper, glm::vec3(11, 1, 5));
}

TEST(Flatten, PartlyMissingAttributes) {
    Scene scene = two_nodes();
    scene.meshes[0].primitives[1].colors.assign(3, {0.5f, 0, 0, 1});
    scene.meshes[0].primitives[1].uvs.assign(3, {2, 3});
    const Geometry g = flatten(scene);
    ASSERT_EQ(g.colors.size(), 12u);
    EXPECT_EQ(g.colors[0], glm::vec4(1));
    EXPECT_EQ(g.colors[3], glm::vec4(0.5f, 0, 0, 1));
    EXPECT_EQ(g.uvs[0], glm::vec2(0));
    EXPECT_EQ(g.uvs[3], glm::vec2(2, 3));
}

TEST(Flatten, ZeroAreaTrianglesAreKeptAndCounted) {
    Scene scene = two_nodes();
    Primitive& p = scene.meshes[0].primitives[0];
    p.positions.push_back({2, 0, 0});
    p.normals.push_back({0, 0, 1});
    p.triangles = {{0, 0, 1}, {0, 1, 2}, {0, 1, 3}};
    const Geometry g = flatten(scene);
    EXPECT_EQ(g.triangles.size(), 8u);
    EXPECT_EQ(g.zero_area, 4u);  // two of them, in two instances
}

TEST(Flatten, NormalsUnderUnevenScale) {
    Scene scene = two_nodes();
    for (Primitive& p : scene.meshes[0].primitives) p.normals.assign(3, glm::normalize(glm::vec3(1, 1, 0)));
    scene.nodes[0].local = glm::scale(glm::mat4(1), {2, 1, 1});
    const glm::vec3 n = flatten(scene).normals[0];
    EXPECT_NEAR(n.x / n.y, 0.5, 1e-5);
    EXPECT_NEAR(glm::length(n), 1, 1e-6);
}

TEST(Flatten, EmptyAndOverflowingScenes) {
    Scene scene = two_nodes();
    scene.nodes[1].local = glm::scale(glm::mat4(1), glm::vec3(3e38f));
    EXPECT_THROW(flatten(scene), Error);
    scene.nodes.clear();
    try {
        flatten(scene);
        ADD_FAILURE();
    } catch (const Error& error) {
        EXPECT_MENTIONS(std::string(error.what()), "two");
    }
}

}  // namespace
}  // namespace peelray::testing
