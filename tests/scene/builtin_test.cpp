#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "scene_files.h"

namespace peelray::testing {
namespace {

using Point = std::tuple<float, float, float>;

Point key(const glm::vec3& p) {
    return {p.x, p.y, p.z};
}

/// Every edge is used once in each direction, and the enclosed volume is positive.
void expect_closed_outwards(const Primitive& p, const std::string& name) {
    std::map<std::pair<Point, Point>, int> edges;
    double volume = 0;
    for (const glm::uvec3& t : p.triangles) {
        for (int k = 0; k < 3; ++k) ++edges[{key(p.positions[t[k]]), key(p.positions[t[(k + 1) % 3]])}];
        volume += glm::dot(glm::dvec3(p.positions[t.x]),
                           glm::cross(glm::dvec3(p.positions[t.y]), glm::dvec3(p.positions[t.z])));
    }
    EXPECT_GT(volume, 0) << name;
    size_t open = 0;
    for (const auto& [edge, count] : edges) open += edges.count({edge.second, edge.first}) == 0 || count != 1;
    EXPECT_EQ(open, 0u) << name;
}

void expect_sound(const Geometry& g, const std::string& name) {
    ASSERT_EQ(g.positions.size(), g.normals.size());
    for (const glm::vec3& n : g.normals) ASSERT_NEAR(glm::length(n), 1, 1e-4) << name;
    for (const glm::vec3& p : g.positions) ASSERT_TRUE(std::isfinite(p.x + p.y + p.z)) << name;
    EXPECT_EQ(g.zero_area, 0u) << name;
    size_t against = 0;
    for (const glm::uvec3& t : g.triangles) {
        const glm::vec3 face = glm::cross(g.positions[t.y] - g.positions[t.x], g.positions[t.z] - g.positions[t.x]);
        against += glm::dot(face, g.normals[t.x] + g.normals[t.y] + g.normals[t.z]) <= 0;
    }
    EXPECT_EQ(against, 0u) << name << ": normals against their triangle";
}

TEST(Builtin, AllAreSound) {
    for (const char* name : {"builtin:teapots", "builtin:glass", "builtin:tree", "builtin:blob:5000"}) {
        const Scene scene = load_scene(name);
        EXPECT_EQ(scene.name, name);
        EXPECT_EQ(scene.cameras.size(), 1u);
        expect_sound(flatten(scene), name);
    }
}

TEST(Builtin, ListNamesWhatCanBeMade) {
    ASSERT_EQ(builtin_scenes().size(), 6u);
    for (const BuiltinScene& scene : builtin_scenes()) {
        EXPECT_FALSE(scene.description.empty());
        if (scene.name == "blob:N") continue;
        EXPECT_NO_THROW(make_builtin(scene.name));
    }
}

TEST(Builtin, GlassBodiesAreClosed) {
    const Scene scene = make_builtin("glass");
    int bodies = 0;
    for (const Mesh& mesh : scene.meshes)
        for (const Primitive& p : mesh.primitives) {
            const Material& material = scene.materials[p.material];
            if (material.transmission == 0) continue;
            ++bodies;
            expect_closed_outwards(p, mesh.name);
            EXPECT_EQ(material.transmission, 1);
            EXPECT_FLOAT_EQ(material.ior, 1.5f);
            EXPECT_GT(material.thickness, 0);
        }
    EXPECT_EQ(bodies, 3);
}

TEST(Builtin, TeapotIsNewells) {
    const Scene scene = make_builtin("teapots");
    const Primitive& pot = scene.meshes.at(1).primitives.at(0);
    glm::vec3 lower(INFINITY), upper(-INFINITY);
    for (const glm::vec3& p : pot.positions) lower = glm::min(lower, p), upper = glm::max(upper, p);
    // The extent of the original data, as every other teapot file has it.
    EXPECT_NEAR(lower.x, -3, 1e-4);
    EXPECT_NEAR(upper.x, 3.434, 1e-3);
    EXPECT_NEAR(lower.y, 0, 1e-6);
    EXPECT_NEAR(upper.y, 3.15, 1e-6);
    EXPECT_NEAR(upper.z, 2, 1e-3);
    ASSERT_EQ(pot.triangles.size(),
              32u * 16 * 16 * 2 - 8 * 16);  // at eight pole edges one triangle a square is missing
    // Handle and spout come last, four patches each: tubes whose outside must be outside.
    for (const size_t first : {pot.triangles.size() - 4096, pot.triangles.size() - 2048}) {
        glm::dvec3 middle{0};
        for (size_t i = first; i < first + 2048; ++i) middle += glm::dvec3(pot.positions[pot.triangles[i].x]) / 2048.0;
        double volume = 0;
        for (size_t i = first; i < first + 2048; ++i) {
            const glm::uvec3 t = pot.triangles[i];
            volume +=
                glm::dot(glm::dvec3(pot.positions[t.x]) - middle,
                         glm::cross(glm::dvec3(pot.positions[t.y]) - middle, glm::dvec3(pot.positions[t.z]) - middle));
        }
        EXPECT_GT(volume, 0.1);
    }
}

TEST(Builtin, TreeHasManyLeaves) {
    const Scene scene = make_builtin("tree");
    const size_t leaves = scene.meshes.at(2).primitives.at(0).triangles.size() / 2;
    EXPECT_GE(leaves, 15000u);
    EXPECT_LE(leaves, 60000u);
    EXPECT_EQ(flatten(make_builtin("tree")).positions, flatten(scene).positions);  // deterministic
}

TEST(Builtin, BlobMeetsItsNumber) {
    for (const size_t n : {8u, 9u, 10u, 12u, 20u, 50u, 99u, 100u, 1000u, 8192u, 123456u}) {
        const Scene scene = make_builtin("blob:" + std::to_string(n));
        const Primitive& p = scene.meshes.at(0).primitives.at(0);
        EXPECT_EQ(p.triangles.size(), n / 2 * 2) << n;
        if (n < 10000) expect_closed_outwards(p, scene.name);
        EXPECT_EQ(scene.meshes.at(1).primitives.at(0).triangles.size(), 2u);
    }
}

TEST(Builtin, BlobHasNoSlivers) {
    const Scene scene = make_builtin("blob:20000");
    const Primitive& p = scene.meshes.at(0).primitives.at(0);
    // Judged before the displacement, which may stretch what it likes: of equilateral triangles each side would be
    // 0.038.
    for (const glm::uvec3& t : p.triangles) {
        const glm::vec3 a = glm::normalize(p.positions[t.x]), b = glm::normalize(p.positions[t.y]),
                        c = glm::normalize(p.positions[t.z]);
        const float longest = std::max({glm::distance(a, b), glm::distance(b, c), glm::distance(c, a)});
        const float height = glm::length(glm::cross(b - a, c - a)) / longest;
        ASSERT_GT(height / longest, 0.35f);
        ASSERT_LT(longest, 2 * 0.038f);
    }
    const Geometry g = flatten(scene);
    EXPECT_EQ(g.lower.x, -2);
    EXPECT_EQ(g.upper.z, 2);
}

TEST(Builtin, Bad) {
    for (const char* name :
         {"builtin:", "builtin:nothing", "builtin:blob", "builtin:blob:", "builtin:blob:7", "builtin:blob:10000001",
          "builtin:blob:-8", "builtin:blob:1e6", "builtin:blob:99999999999999999999", "builtin:blob:12 "})
        error_of(name);
    EXPECT_MENTIONS(error_of("builtin:nothing"), "teapots, glass, tree, blob:N");
}

}  // namespace
}  // namespace peelray::testing
