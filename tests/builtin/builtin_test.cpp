#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "builtin/builtin.h"
#include "loaders/load.h"
#include "loaders/scene_files.h"
#include "motion/animation.h"
#include "scene/alpha_test.h"

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
    for (const char* name :
         {"builtin:teapots", "builtin:glass", "builtin:tree", "builtin:leaves", "builtin:room", "builtin:walker",
          "builtin:desk", "builtin:kitchen", "builtin:kitchen:8", "builtin:kitchen:3000", "builtin:bricks",
          "builtin:bricks:8", "builtin:bricks:3000", "builtin:cloth:2000", "builtin:blob:5000", "builtin:waves",
          "builtin:waves:20", "builtin:particles", "builtin:particles:8"}) {
        const Scene scene = load_scene(name);
        EXPECT_TRUE(scene.name.starts_with(name)) << scene.name << " for " << name;
        EXPECT_EQ(scene.cameras.size(), 1u);
        expect_sound(flatten(scene), name);
    }
}

TEST(Builtin, ListNamesWhatCanBeMade) {
    ASSERT_EQ(builtin_scenes().size(), 13u);
    for (const BuiltinScene& scene : builtin_scenes()) {
        EXPECT_FALSE(scene.description.empty());
        if (scene.name == "blob:N") continue;
        EXPECT_NO_THROW(make_builtin(scene.name));
    }
}

TEST(Builtin, GlassBodiesAreClosed) {
    int bodies = 0;
    for (const char* name : {"glass", "room", "walker", "particles"}) {
        const Scene scene = make_builtin(name);
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
    }
    EXPECT_EQ(bodies, 8);
}

TEST(Builtin, RoomIsClosedAroundItsCameraAndItsLamps) {
    const Scene scene = make_builtin("room");
    const Geometry geometry = flatten(scene);
    std::vector<glm::vec3> inside = {scene.cameras.at(0).eye, scene.cameras.at(0).look};
    ASSERT_EQ(scene.lights.size(), 2u);
    for (const Light& light : scene.lights) inside.push_back(light.position);
    for (const glm::vec3& p : inside) {
        EXPECT_TRUE(glm::all(glm::greaterThan(p, geometry.lower)) && glm::all(glm::lessThan(p, geometry.upper)));
        // Every way ends at a wall at the latest: each of the six stands across the whole room and faces it.
        for (int axis = 0; axis < 3; axis++)
            for (const bool upper : {false, true}) {
                const float at = upper ? geometry.upper[axis] : geometry.lower[axis];
                float area = 0;
                for (const glm::uvec3& t : geometry.triangles) {
                    const glm::vec3 a = geometry.positions[t.x], b = geometry.positions[t.y],
                                    c = geometry.positions[t.z];
                    if (std::max({std::abs(a[axis] - at), std::abs(b[axis] - at), std::abs(c[axis] - at)}) > 1e-5f)
                        continue;
                    const glm::vec3 face = 0.5f * glm::cross(b - a, c - a);
                    area += upper ? -face[axis] : face[axis];
                }
                const glm::vec3 size = geometry.upper - geometry.lower;
                EXPECT_NEAR(area, size[(axis + 1) % 3] * size[(axis + 2) % 3], 1e-3f);
            }
    }
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

TEST(Builtin, LeavesAreCutOut) {
    const Scene scene = make_builtin("leaves");
    const Geometry geometry = flatten(scene);
    const AlphaTest alpha(scene, geometry);
    size_t masked = 0, present = 0, places = 0;
    for (uint32_t i = 0; i < geometry.triangles.size(); i++) {
        if (!alpha.is_masked(i)) continue;
        masked++;
        for (const double u : {0.1, 0.3, 0.5})
            for (const double v : {0.1, 0.3, 0.45}) present += alpha.is_present(i, u, v), places++;
    }
    EXPECT_EQ(masked, 2u * 2 * 420);  // two trees of squares
    EXPECT_GT(present, places / 5);
    EXPECT_LT(present, places * 4 / 5);
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

TEST(Builtin, KitchenAndBricksMeetTheirNumbers) {
    for (const char* name : {"kitchen", "bricks"})
        for (const size_t n : {8u, 9u, 20u, 200u, 1000u, 5001u, 60000u, 200000u}) {
            const Scene scene = make_builtin(fmt::format("{}:{}", name, n));
            const Geometry geometry = flatten(scene);
            EXPECT_NEAR(double(geometry.triangles.size() - 2), double(n), 12 + 0.005 * double(n)) << name << " " << n;
            EXPECT_GE(geometry.lower.y, 0) << name;
            EXPECT_EQ(scene.notes.size(), 1u);
            EXPECT_EQ(flatten(make_builtin(fmt::format("{}:{}", name, n))).positions, geometry.positions);
        }
}

/// All that is one body as a whole: what is looked at and the room around it are not.
TEST(Builtin, ThingsAreClosed) {
    for (const char* name : {"kitchen:20000", "bricks:40000", "desk"}) {
        const Scene scene = make_builtin(name);
        size_t bodies = 0;
        for (const Node& node : scene.nodes) {
            const Primitive& p = scene.meshes[size_t(node.mesh)].primitives.at(0);
            if (p.triangles.size() <= 2) continue;
            expect_closed_outwards(p, std::string(name) + ": " + node.name);
            bodies++;
        }
        EXPECT_GT(bodies, 20u) << name;
    }
}

TEST(Builtin, BricksAreCutIntoSliversAsCadDoes) {
    const Geometry g = flatten(make_builtin("bricks:100000"));
    size_t slivers = 0;
    for (const glm::uvec3& t : g.triangles) {
        const glm::vec3 a = g.positions[t.x], b = g.positions[t.y], c = g.positions[t.z];
        const float longest = std::max({glm::distance(a, b), glm::distance(b, c), glm::distance(c, a)});
        slivers += glm::length(glm::cross(b - a, c - a)) < 0.1f * longest * longest;
    }
    EXPECT_GT(slivers, g.triangles.size() / 6);
}

TEST(Builtin, DeskIsAThousandToOne) {
    const Scene scene = make_builtin("desk");
    const Geometry geometry = flatten(scene);
    EXPECT_GT(geometry.triangles.size(), 50000u);
    EXPECT_LT(geometry.triangles.size(), 150000u);
    const glm::vec3 size = geometry.upper - geometry.lower;
    // The watch's jewels are a millimetre wide.
    std::vector<float> jewels;
    for (const Node& node : scene.nodes) {
        if (node.name != "watch: jewels") continue;
        const Primitive& p = scene.meshes[size_t(node.mesh)].primitives.at(0);
        for (const glm::uvec3& t : p.triangles)
            jewels.push_back(0.001f * glm::distance(p.positions[t.x], p.positions[t.y]));
    }
    ASSERT_FALSE(jewels.empty());
    EXPECT_GT(size.x / *std::max_element(jewels.begin(), jewels.end()), 1000);
    // The camera is in the room, before the watch.
    const glm::dvec3 eye = scene.cameras.at(0).eye;
    EXPECT_LT(glm::length(eye), 0.2);
    EXPECT_TRUE(glm::all(glm::greaterThan(glm::vec3(eye), geometry.lower)) &&
                glm::all(glm::lessThan(glm::vec3(eye), geometry.upper)));
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

/// FNV-1a over the bytes.
template <typename T>
uint64_t hash(const std::vector<T>& values) {
    uint64_t out = 14695981039346656037ull;
    const auto* bytes = reinterpret_cast<const unsigned char*>(values.data());
    for (size_t i = 0; i < values.size() * sizeof(T); ++i) out = (out ^ bytes[i]) * 1099511628211ull;
    return out;
}

TEST(Builtin, BlobAtRestIsWhatItWasBeforeItCouldSwell) {
    Scene scene = load_scene("builtin:blob:20000");
    const Geometry rest = flatten(scene);
    EXPECT_EQ(hash(rest.triangles), 15758965901404249849ull);
#ifdef __x86_64__  // elsewhere compilers may fuse a multiplication and an addition and round once
    EXPECT_EQ(hash(rest.positions), 1415472661313793728ull);
    EXPECT_EQ(hash(rest.normals), 4165513890747359009ull);
#endif
    EXPECT_TRUE(scene.meshes.at(0).primitives.at(0).targets.empty());  // a still picture does not pay for them
    complete_targets(scene);
    EXPECT_EQ(scene.meshes.at(0).primitives.at(0).targets.size(), 1u);
    const Geometry start = flatten(scene, moment_of(scene, "swell", 0));
    EXPECT_EQ(start.positions, rest.positions);
    EXPECT_EQ(start.normals, rest.normals);
}

/// Of each triangle: the cosine between the mean of its corners' normals and its own.
std::vector<float> agreements(const Geometry& g) {
    std::vector<float> out;
    for (const glm::uvec3& t : g.triangles) {
        const glm::vec3 face = glm::cross(g.positions[t.y] - g.positions[t.x], g.positions[t.z] - g.positions[t.x]);
        out.push_back(glm::dot(glm::normalize(face), glm::normalize(g.normals[t.x] + g.normals[t.y] + g.normals[t.z])));
    }
    return out;
}

TEST(Builtin, BlobSwellsAndComesBack) {
    Scene scene = load_scene("builtin:blob:20000");
    const Geometry rest = flatten(scene);
    complete_targets(scene);
    const float duration = scene.animations.at(0).duration, floor = rest.lower.y;
    EXPECT_NEAR(duration, 2, 0.5);
    const auto at = [&](float time) { return flatten(scene, moment_of(scene, "swell", time)); };
    EXPECT_EQ(at(duration).positions, rest.positions);
    // No jump where it starts again: the way of the last hundredth is as short as that of the first.
    const Geometry first = at(0.01f * duration), last = at(0.99f * duration);
    for (size_t i = 0; i < rest.positions.size(); ++i) {
        ASSERT_LT(glm::distance(first.positions[i], rest.positions[i]), 2e-3f);
        ASSERT_LT(glm::distance(last.positions[i], rest.positions[i]), 2e-3f);
    }
    for (const float share : {0.15f, 0.25f, 0.35f, 0.5f, 0.8f}) {
        SCOPED_TRACE(share);
        const Geometry g = at(share * duration);
        expect_sound(g, "swollen");
        std::vector<float> agreement = agreements(g);
        std::sort(agreement.begin(), agreement.end());
        EXPECT_GT(agreement[agreement.size() / 100], 0.8f);  // all but one in a hundred
        // One radius for each direction: every triangle is seen from the middle from behind, so that none covers
        // another.
        const size_t blob = g.triangles.size() - 2;
        for (size_t i = 0; i < blob; ++i) {
            const glm::uvec3 t = g.triangles[i];
            const glm::dvec3 a = g.positions[t.x], b = g.positions[t.y], c = g.positions[t.z];
            ASSERT_GT(glm::dot(glm::cross(b - a, c - a), a), 0) << i;
            for (int k = 0; k < 3; ++k) ASSERT_GT(g.positions[t[k]].y, floor + 0.019f);
        }
    }
    // It deforms all over: half of the surface moves by more than a tenth of the radius.
    const Geometry most = at(0.5f * duration);
    std::vector<float> ways;
    for (size_t i = 0; i < rest.positions.size(); ++i)
        ways.push_back(glm::distance(most.positions[i], rest.positions[i]));
    std::sort(ways.begin(), ways.end());
    EXPECT_GT(ways[ways.size() / 2], 0.072f);
    EXPECT_GT(ways.back(), 0.25f);
    EXPECT_LT(ways.back(), 0.72f);
}

TEST(Builtin, SmallBlobsSwell) {
    for (const size_t n : {8u, 10u, 50u}) {
        Scene scene = load_scene("builtin:blob:" + std::to_string(n));
        complete_targets(scene);
        const Geometry g = flatten(scene, moment_of(scene, "0", 1.1));
        EXPECT_EQ(g.zero_area, 0u);
        for (size_t i = 0; i + 4 < g.positions.size(); ++i) EXPECT_GT(g.positions[i].y, g.lower.y);
    }
}

TEST(Builtin, Bad) {
    for (const char* name :
         {"builtin:", "builtin:nothing", "builtin:blob", "builtin:blob:", "builtin:blob:7", "builtin:blob:10000001",
          "builtin:blob:-8", "builtin:blob:1e6", "builtin:blob:99999999999999999999", "builtin:blob:12 ",
          "builtin:kitchen:", "builtin:kitchen:7", "builtin:kitchen:10000001", "builtin:bricks:7", "builtin:bricks:x",
          "builtin:cloth:7", "builtin:cloth:10000001", "builtin:desk:8"})
        error_of(name);
    EXPECT_MENTIONS(
        error_of("builtin:nothing"),
        "teapots, glass, tree, leaves, room, walker, desk, kitchen, bricks, cloth, blob:N, waves, particles");
}

}  // namespace
}  // namespace peelray::testing
