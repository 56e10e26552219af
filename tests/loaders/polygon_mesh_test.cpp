// Polygons of mesh files into primitives: triangles, vertices that are split and joined, normals.

#include "loaders/polygon_mesh.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "loaders/scene_files.h"
#include "scene/normals.h"
#include "scene/triangulate.h"

namespace peelray::testing {
namespace {

/// Twice the signed areas of a flat polygon's triangles (normal +z), and of the polygon itself at the end.
std::vector<double> areas(const std::vector<glm::vec3>& polygon) {
    std::vector<glm::uvec3> triangles;
    EXPECT_TRUE(triangulate(polygon, triangles));
    EXPECT_EQ(triangles.size(), polygon.size() - 2);
    std::vector<double> out;
    const auto cross = [](const glm::dvec3& a, const glm::dvec3& b) { return a.x * b.y - a.y * b.x; };
    for (const glm::uvec3& t : triangles) {
        const glm::dvec3 a = polygon[t.x];
        out.push_back(cross(glm::dvec3(polygon[t.y]) - a, glm::dvec3(polygon[t.z]) - a));
    }
    double whole = 0;
    for (size_t i = 0; i < polygon.size(); ++i) whole += cross(polygon[i], polygon[(i + 1) % polygon.size()]);
    out.push_back(whole);
    return out;
}

/// No triangle is turned over and together they are as large as the polygon: they tile it.
void expect_tiled(const std::vector<glm::vec3>& polygon) {
    std::vector<double> parts = areas(polygon);
    const double whole = parts.back();
    parts.pop_back();
    double sum = 0;
    for (const double part : parts) {
        EXPECT_GE(part * whole, 0);
        sum += part;
    }
    EXPECT_NEAR(sum, whole, 1e-6 * std::abs(whole));
}

TEST(Triangulate, ConvexPolygonsAreFans) {
    std::vector<glm::uvec3> triangles;
    triangulate(std::vector<glm::vec3>{{0, 0, 0}, {1, 0, 0}, {1.2f, 1, 0}, {0.5f, 1.5f, 0}, {0, 1, 0}}, triangles);
    EXPECT_EQ(triangles, (std::vector<glm::uvec3>{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}}));
}

TEST(Triangulate, ConcavePolygonsAreTiled) {
    std::vector<glm::vec3> arrow = {{0, 0, 0}, {2, -1, 0}, {0.5f, 0, 0}, {2, 1, 0}};
    for (int turn = 0; turn < 4; ++turn) {
        expect_tiled(arrow);
        std::rotate(arrow.begin(), arrow.begin() + 1, arrow.end());
    }
    std::vector<glm::vec3> comb;
    for (int i = 0; i < 20; ++i) {
        comb.emplace_back(i, 0, 0);
        comb.emplace_back(i + 0.5f, -5, 0);
    }
    comb.emplace_back(20, 0, 0);
    comb.emplace_back(20, 1, 0);
    comb.emplace_back(0, 1, 0);
    expect_tiled(comb);
    std::reverse(comb.begin(), comb.end());
    expect_tiled(comb);
    // A square with a hole, joined to it by a way in and the same way out.
    expect_tiled(
        {{0, 0, 0}, {3, 0, 0}, {3, 3, 0}, {0, 3, 0}, {0, 0, 0}, {1, 1, 0}, {1, 2, 0}, {2, 2, 0}, {2, 1, 0}, {1, 1, 0}});
    // A spiral: every fan leaves it.
    std::vector<glm::vec3> spiral;
    for (int i = 0; i <= 60; ++i)
        spiral.emplace_back((1 + i * 0.1) * std::cos(i * 0.2), (1 + i * 0.1) * std::sin(i * 0.2), 0);
    for (int i = 60; i >= 0; --i)
        spiral.emplace_back((0.8 + i * 0.1) * std::cos(i * 0.2), (0.8 + i * 0.1) * std::sin(i * 0.2), 0);
    expect_tiled(spiral);
}

TEST(Triangulate, PolygonsWithoutAnInsideStillGiveAllTriangles) {
    for (const std::vector<glm::vec3>& polygon :
         {std::vector<glm::vec3>(7, glm::vec3(1)),
          std::vector<glm::vec3>{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {1, 0, 0}},
          std::vector<glm::vec3>{{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}, {0.5f, 3, 0}, {0.2f, -1, 0}}}) {
        std::vector<glm::uvec3> triangles;
        triangulate(polygon, triangles);
        EXPECT_EQ(triangles.size(), polygon.size() - 2);
    }
}

/// Two triangles that share an edge, in the plane z = 0.
PolygonMesh two_triangles() {
    PolygonMesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    mesh.corners = {0, 1, 2, 0, 2, 3};
    return mesh;
}

Scene convert(PolygonMesh mesh) {
    Scene scene;
    scene.name = "mesh";
    scene.materials.resize(4);
    add_polygon_mesh(std::move(mesh), scene);
    return scene;
}

using Per = MeshAttribute<glm::vec2>::Per;

TEST(PolygonMesh, VerticesAreSharedUnlessCornersDiffer) {
    EXPECT_EQ(convert(two_triangles()).meshes[0].primitives[0].positions.size(), 4u);
    PolygonMesh mesh = two_triangles();
    mesh.uvs.per = Per::corner;
    mesh.uvs.values = {{0, 0}, {1, 0}, {1, 1}, {0, 0}, {0.5f, 0.5f}, {0, 1}};
    const Primitive p = convert(mesh).meshes[0].primitives[0];
    EXPECT_EQ(p.positions.size(), 5u);  // only the corner at (1, 1) differs
    EXPECT_EQ(p.uvs[p.triangles[0].z], glm::vec2(1, 0));
    EXPECT_EQ(p.uvs[p.triangles[1].y], glm::vec2(0.5f, 0.5f));
}

TEST(PolygonMesh, ValuesByIndexAsInObj) {
    PolygonMesh mesh = two_triangles();
    mesh.uvs.per = Per::corner;
    mesh.uvs.values = {{0, 0}, {0.25f, 0.25f}};
    mesh.uvs.indices = {0, 1, 1, 0, 1, no_value};
    const Primitive p = convert(mesh).meshes[0].primitives[0];
    EXPECT_EQ(p.positions.size(), 4u);
    EXPECT_EQ(p.uvs[p.triangles[0].y], glm::vec2(0.25f, 0.75f));
    EXPECT_EQ(p.uvs[p.triangles[1].z], glm::vec2(0, 1));
}

TEST(PolygonMesh, FaceColorsSplitVertices) {
    PolygonMesh mesh = two_triangles();
    mesh.colors.per = MeshAttribute<glm::vec4>::Per::face;
    mesh.colors.values = {{1, 0, 0, 1}, {0, 1, 0, 1}};
    const Geometry g = flatten(convert(mesh));
    EXPECT_EQ(g.positions.size(), 6u);
    for (int k = 0; k < 3; ++k) {
        EXPECT_EQ(g.colors[g.triangles[0][k]], glm::vec4(1, 0, 0, 1));
        EXPECT_EQ(g.colors[g.triangles[1][k]], glm::vec4(0, 1, 0, 1));
    }
}

TEST(PolygonMesh, PartsAndObjectsKeepTheOrder) {
    PolygonMesh mesh;
    for (int i = 0; i < 5; ++i)
        for (const glm::vec3& p :
             {glm::vec3(i, 0, 0), glm::vec3(i + 1, 0, 0), glm::vec3(i + 1, 1, 0), glm::vec3(i, 1, 0)})
            mesh.positions.push_back(p);
    mesh.corners = {0, 1, 2, 3, 4, 5, 6, 8, 9, 10, 11, 12, 13, 14, 16, 17, 18};
    mesh.ends = {4, 7, 11, 14, 17};
    mesh.objects = {"one", "two"};
    mesh.parts = {{0, 0, 1}, {1, 1, 2}, {3, 0, 3}};
    const Scene scene = convert(mesh);
    ASSERT_EQ(scene.nodes.size(), 2u);
    EXPECT_EQ(scene.nodes[1].name, "two");
    const Geometry g = flatten(scene);
    std::vector<float> lefts;
    for (const glm::uvec3& t : g.triangles) lefts.push_back(std::floor(g.positions[t.x].x));
    EXPECT_EQ(lefts, (std::vector<float>{0, 0, 3, 4, 1, 2, 2}));
    EXPECT_EQ(g.materials, (std::vector<uint32_t>{1, 1, 3, 3, 2, 2, 2}));
}

TEST(PolygonMesh, NotesSayWhatWasDropped) {
    PolygonMesh mesh = two_triangles();
    mesh.positions.emplace_back(NAN, 0, 0);  // nobody's
    mesh.corners.insert(mesh.corners.end(), {0, 1});
    mesh.ends = {3, 6, 8};
    mesh.normals.values = {{0, 0, 1}, {0, 0, 0}, {0, 0, NAN}, {0, 0, 3}, {1, 0, 0}};
    mesh.uvs.values = {{0, 0}, {INFINITY, 0}, {0, 0}, {0, 0}, {0, 0}};
    mesh.colors.values = {{2, 0, 0, 1}, {1, 1, 1, 0.5f}, {1, 1, 1, 1}, {1, 1, 1, 1}, {1, 1, 1, 1}};
    const Scene scene = convert(mesh);
    EXPECT_EQ(
        scene.notes,
        (std::vector<std::string>{
            "1 polygon with fewer than three corners dropped", "1 vertex that no polygon uses dropped",
            "2 normals without direction replaced", "1 texture coordinate that is not finite replaced by 0",
            "1 vertex colour outside of 0 to 1 limited to it", "1 vertex colour with an alpha below 1 drawn opaque"}));
    for (const glm::vec3& n : scene.meshes[0].primitives[0].normals) EXPECT_EQ(n, glm::vec3(0, 0, 1));
}

TEST(PolygonMesh, Bad) {
    const auto error = [](PolygonMesh mesh) -> std::string {
        try {
            convert(std::move(mesh));
        } catch (const Error& e) {
            return e.what();
        }
        return "";
    };
    PolygonMesh mesh = two_triangles();
    mesh.positions[2].y = -INFINITY;
    EXPECT_MENTIONS(error(mesh), "mesh: vertex 2 is at (1, -inf, 0)");
    mesh = two_triangles();
    mesh.corners[4] = 4;
    EXPECT_MENTIONS(error(mesh), "polygon 1 has index 4, the file has 4 vertices");
}

TEST(PolygonMesh, ManyDifferentCornersAtOneVertexTakeLinearTime) {
    PolygonMesh mesh;
    constexpr uint32_t count = 200'000;
    mesh.positions.emplace_back(0);
    mesh.uvs.per = Per::corner;
    for (uint32_t i = 0; i < count; ++i) {
        mesh.positions.emplace_back(std::cos(i * 1e-5f), std::sin(i * 1e-5f), 0);
        if (i == 0) continue;
        mesh.corners.insert(mesh.corners.end(), {0, i, i + 1});
        mesh.uvs.values.insert(mesh.uvs.values.end(), 3, glm::vec2(i, 0));
    }
    EXPECT_EQ(convert(mesh).meshes[0].primitives[0].positions.size(), (count - 1) * 3);
}

TEST(PolygonMesh, IntegerColorsAreEncoded) {
    EXPECT_NEAR(encoded_color(128, 0, 255, 128).x, 0.21586, 1e-5);
    EXPECT_EQ(encoded_color(128, 0, 255, 51).z, 1);
    EXPECT_EQ(encoded_color(128, 0, 255, 51).w, 0.2f);
    EXPECT_FLOAT_EQ(encoded_color(glm::vec4(128 / 255.f, 0, 1, 1)).x, encoded_color(128, 0, 255).x);
}

/// Normals as normals.h describes them, corner by corner against all others.
glm::vec3 expected_normal(const Primitive& p, size_t triangle, int k, float crease) {
    const auto face = [&](const glm::uvec3& t) {
        const glm::dvec3 a = p.positions[t.x];
        return glm::normalize(glm::cross(glm::dvec3(p.positions[t.y]) - a, glm::dvec3(p.positions[t.z]) - a));
    };
    const glm::vec3 at = p.positions[p.triangles[triangle][k]];
    const glm::dvec3 own = face(p.triangles[triangle]);
    glm::dvec3 sum(0);
    for (const glm::uvec3& t : p.triangles)
        for (int j = 0; j < 3; ++j) {
            if (p.positions[t[j]] != at || glm::dot(own, face(t)) < std::cos(crease)) continue;
            const glm::dvec3 a = glm::normalize(glm::dvec3(p.positions[t[(j + 1) % 3]] - at)),
                             b = glm::normalize(glm::dvec3(p.positions[t[(j + 2) % 3]] - at));
            sum += face(t) * std::acos(std::clamp(glm::dot(a, b), -1.0, 1.0));
        }
    return glm::normalize(sum);
}

TEST(Normals, SmoothNormalsFollowTheirDefinition) {
    // A rough height field of triangles whose vertices repeat, so that positions decide who is whose neighbour.
    Primitive p;
    std::mt19937 random(3);
    std::vector<float> heights(12 * 12);
    for (float& h : heights) h = static_cast<float>(random() % 1000) * 0.002f;
    const auto vertex = [&](size_t x, size_t y) {
        p.positions.emplace_back(x, heights[y * 12 + x], y);
        return static_cast<uint32_t>(p.positions.size() - 1);
    };
    for (size_t y = 0; y < 11; ++y)
        for (size_t x = 0; x < 11; ++x) {
            p.triangles.emplace_back(vertex(x, y), vertex(x, y + 1), vertex(x + 1, y));
            p.triangles.emplace_back(vertex(x + 1, y), vertex(x, y + 1), vertex(x + 1, y + 1));
        }
    const Primitive before = p;
    make_smooth(p, 1.f);
    ASSERT_EQ(p.triangles.size(), before.triangles.size());
    EXPECT_LT(p.positions.size(), before.positions.size());
    EXPECT_GT(p.positions.size(), 144u);
    for (size_t i = 0; i < p.triangles.size(); ++i)
        for (int k = 0; k < 3; ++k) {
            EXPECT_EQ(p.positions[p.triangles[i][k]], before.positions[before.triangles[i][k]]);
            EXPECT_NEAR(glm::distance(p.normals[p.triangles[i][k]], expected_normal(before, i, k, 1.f)), 0, 1e-5);
        }
}

TEST(Normals, GivenNormalsStayAndMissingOnesAreMade) {
    Primitive p;
    p.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    p.triangles = {{0, 1, 2}, {0, 2, 3}};
    p.normals = {{1, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 1, 0}};
    complete_normals(p, 1);
    ASSERT_EQ(p.positions.size(), 4u);
    EXPECT_EQ(p.normals[p.triangles[0].x], glm::vec3(1, 0, 0));
    EXPECT_EQ(p.normals[p.triangles[0].y], glm::vec3(0, 0, 1));
    EXPECT_EQ(p.normals[p.triangles[1].z], glm::vec3(0, 1, 0));
}

}  // namespace
}  // namespace peelray::testing
