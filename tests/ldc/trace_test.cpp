// The traversal against the oracle and its defined answers for odd rays.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <thread>

#include "../gpu/device_fixture.h"
#include "effort.h"
#include "loaders/load.h"
#include "ray_sets.h"
#include "reference/oracle.h"
#include "traced_body.h"

namespace peelray {
namespace {

using test::oracle_ray;
using test::RayKind;
using test::TracedBody;
const float kInfinity = std::numeric_limits<float>::infinity();

/// Runs `body(i)` for all i on all cores.
template <typename Body>
void parallel_for(size_t count, Body body) {
    std::atomic<size_t> next{0};
    std::vector<std::thread> threads;
    for (unsigned t = 0; t < std::max(1u, std::thread::hardware_concurrency()); t++)
        threads.emplace_back([&] {
            for (size_t first; (first = next.fetch_add(4096)) < count;)
                for (size_t i = first; i < std::min(count, first + 4096); i++) body(i);
        });
    for (auto& thread : threads) thread.join();
}

class TraceTest : public DeviceTest {
  protected:
    /// Every ray of all kinds must have a right answer; reports the first wrong ray of each kind in full.
    void compare(const Geometry& geometry, uint32_t resolution, size_t rays_per_kind) {
        TracedBody scene(device(), geometry, resolution, HitTest::exact);
        const Oracle oracle(geometry);
        for (RayKind kind : {RayKind::uniform, RayKind::grazing, RayKind::axis_parallel, RayKind::on_surface}) {
            test::RaySource source(geometry, 1234 + resolution);
            std::vector<Ray> rays(rays_per_kind);
            for (Ray& ray : rays) ray = source.make(kind);
            const auto hits = scene.trace(rays);
            const auto any = scene.trace(rays, true);
            std::atomic<size_t> wrong{0}, second_look{0}, first{~0ull}, wrong_any{0}, hit_count{0};
            parallel_for(rays.size(), [&](size_t i) {
                const Verdict verdict = oracle.check(oracle_ray(rays[i]), hits[i].t, hits[i].triangle);
                if (verdict == Verdict::within_offset) second_look++;
                if (hits[i].triangle != ~0u) hit_count++;
                if (verdict == Verdict::wrong) {
                    wrong++;
                    first = i;
                }
                if (oracle.check_any(oracle_ray(rays[i]), any[i].triangle != ~0u) == Verdict::wrong) wrong_any++;
            });
            fmt::print("  {}: {} rays, {} hits, {} needed the second look\n", test::name_of(kind), rays.size(),
                       hit_count.load(), second_look.load());
            EXPECT_EQ(wrong_any.load(), 0u) << test::name_of(kind);
            EXPECT_EQ(wrong.load(), 0u) << test::name_of(kind);
            EXPECT_GT(hit_count.load(), rays.size() / 50) << "rays that hit nothing prove nothing";
            if (wrong.load()) {
                const Ray& r = rays[first];
                const OracleHit right = oracle.closest(oracle_ray(r));
                ADD_FAILURE() << fmt::format(
                    "ray {}: origin {:.9g} {:.9g} {:.9g} direction {:.9g} {:.9g} {:.9g}: ours t {} triangle {}, right "
                    "t {} triangle {}",
                    first.load(), r.origin.x, r.origin.y, r.origin.z, r.direction.x, r.direction.y, r.direction.z,
                    hits[first].t, int(hits[first].triangle), right.t, int(right.triangle));
            }
        }
    }
};

class ExactOnScene : public TraceTest, public ::testing::WithParamInterface<const char*> {};

TEST_P(ExactOnScene, AgreesWithOracle) {
    std::string name = GetParam();
    if (!name.starts_with("builtin:")) {
        name = std::string(PEELRAY_MODELS) + "/meshes/" + name;
        if (!std::filesystem::exists(name)) GTEST_SKIP() << "the test models are not here: " << name;
    }
    const Geometry geometry = flatten(load_scene(name));
    fmt::print("{}: {} triangles\n", GetParam(), geometry.triangles.size());
    // In `make test-long` 4·10^5 rays per scene; PEELRAY_RAYS_PER_KIND asks for more.
    const char* rays = std::getenv("PEELRAY_RAYS_PER_KIND");
    compare(geometry, 256, rays ? std::strtoull(rays, nullptr, 10) : test::effort(10'000, 100'000));
}

INSTANTIATE_TEST_SUITE_P(Scenes, ExactOnScene,
                         ::testing::Values("builtin:teapots", "builtin:glass", "builtin:tree", "builtin:blob:100000",
                                           "stanford-bunny.obj", "chinesedragon.gltf", "igea.ply", "nefertiti.obj",
                                           "car2.glb"),
                         [](const auto& info) {
                             std::string name = info.param;
                             for (char& c : name)
                                 if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
                             return name;
                         });

TEST_F(TraceTest, ExactDoesNotDependOnResolution) {
    const Geometry geometry = flatten(load_scene("builtin:blob:20000"));
    for (uint32_t resolution : {16u, 48u, 100u, 777u}) compare(geometry, resolution, test::effort(4000, 20'000));
}

TEST_F(TraceTest, ExactFarFromTheWorldsOriginAndAtOddScales) {
    Geometry geometry = flatten(load_scene("builtin:blob:5000"));
    const Geometry original = geometry;
    for (const auto& [scale, shift] :
         {std::pair(1e-6f, glm::vec3(0)), std::pair(1e6f, glm::vec3(0)), std::pair(1.f, glm::vec3(20, -30, 40))}) {
        for (size_t i = 0; i < geometry.positions.size(); i++)
            geometry.positions[i] = original.positions[i] * scale + shift;
        geometry.lower = original.lower * scale + shift;
        geometry.upper = original.upper * scale + shift;
        compare(geometry, 128, 20'000);
    }
}

/// A cube of edge 2 around the origin, one square of two triangles per face.
Geometry box_geometry() {
    Geometry g;
    for (int face = 0; face < 6; face++) {
        const int axis = face / 2;
        const float side = face % 2 ? 1.f : -1.f;
        const uint32_t first = uint32_t(g.positions.size());
        for (int corner = 0; corner < 4; corner++) {
            glm::vec3 p(0);
            p[axis] = side;
            p[(axis + 1) % 3] = corner & 1 ? 1.f : -1.f;
            p[(axis + 2) % 3] = corner & 2 ? 1.f : -1.f;
            g.positions.push_back(p);
        }
        g.triangles.push_back({first, first + 1, first + 2});
        g.triangles.push_back({first + 1, first + 3, first + 2});
    }
    g.lower = glm::vec3(-1);
    g.upper = glm::vec3(1);
    return g;
}

TEST_F(TraceTest, OddRaysHaveDefinedAnswers) {
    TracedBody scene(device(), box_geometry(), 64, HitTest::exact);
    const float nan = std::nanf(""), tiny = 1e-30f, denormal = 1e-41f;
    struct Case {
        Ray ray;
        float t;  // infinite: a miss
        const char* what;
    };
    const std::vector<Case> cases = {
        {{{0, 0, 0}, 0, {0, 0, 1}, kInfinity}, 1, "from the inside, two zero components"},
        {{{0, 0, 0}, 0, {0, 0, -4}, kInfinity}, 0.25f, "t counts in lengths of the direction"},
        {{{0, 0, -5}, 0, {0, 0, 1}, kInfinity}, 4, "from outside"},
        {{{0, 0, -5e6f}, 0, {0, 0, 1}, kInfinity}, 5e6f - 1, "from far outside"},
        {{{0.25f, 0.5f, -1}, 0, {0, 0, 1}, kInfinity}, 2, "starting on a face is no hit of that face (t > tmin)"},
        {{{0.25f, 0.5f, -3}, 0, {0, 0, -1}, kInfinity}, kInfinity, "away from the box"},
        {{{0.3f, 0.2f, 0}, 0, {0, 0, 1}, 0.5f}, kInfinity, "tmax before the face"},
        {{{0.3f, 0.2f, -5}, 4.5f, {0, 0, 1}, kInfinity}, 6, "tmin behind the first face"},
        {{{0.3f, 0.2f, 0}, -2, {0, 0, 1}, kInfinity}, -1, "negative tmin sees what lies behind"},
        {{{0, 0, 0}, 2, {0, 0, 1}, 1}, kInfinity, "tmin beyond tmax"},
        {{{0, 0, 0}, 1, {0, 0, 1}, 1}, kInfinity, "tmin equals tmax"},
        {{{0, 0, 0}, 0, {0, 0, 0}, kInfinity}, kInfinity, "no direction"},
        {{{0, 0, 0}, 0, {nan, 0, 1}, kInfinity}, kInfinity, "NaN in the direction"},
        {{{0, 0, 0}, 0, {0, nan, nan}, kInfinity}, kInfinity, "NaN in the direction"},
        {{{0, 0, 0}, 0, {kInfinity, 0, 1}, kInfinity}, kInfinity, "infinite direction"},
        {{{nan, 0, 0}, 0, {0, 0, 1}, kInfinity}, kInfinity, "NaN in the origin"},
        {{{0, kInfinity, 0}, 0, {0, 0, 1}, kInfinity}, kInfinity, "infinite origin"},
        {{{0, 0, 0}, nan, {0, 0, 1}, kInfinity}, kInfinity, "NaN tmin"},
        {{{0, 0, 0}, 0, {0, 0, 1}, nan}, kInfinity, "NaN tmax"},
        {{{0, 0, 0}, 0, {tiny, tiny, 1}, kInfinity}, 1, "tiny components"},
        {{{0, 0, 0}, 0, {denormal, 0, 1}, kInfinity}, 1, "denormal component"},
        {{{0, 0, 0}, 0, {0, 0, 1e-20f}, kInfinity}, 1e20f, "short direction"},
        {{{0, 0, 0}, 0, {0, 0, 1e20f}, kInfinity}, 1e-20f, "long direction"},
        {{{1, 1, 5}, 0, {0, 0, -1}, kInfinity}, 4, "along an edge of the box"},
        {{{-5, 1, 0.5f}, 0, {1, 0, 0}, kInfinity}, 4, "in the plane of a face"},
        {{{3, 3, 3}, 0, {-1, -1, -1}, kInfinity}, 2, "into a corner"},
    };
    std::vector<Ray> rays;
    for (const Case& c : cases) rays.push_back(c.ray);
    const auto hits = scene.trace(rays);
    const auto any = scene.trace(rays, true);
    for (size_t i = 0; i < cases.size(); i++) {
        if (std::isinf(cases[i].t)) {
            EXPECT_EQ(hits[i].triangle, ~0u) << cases[i].what;
            EXPECT_TRUE(std::isinf(hits[i].t)) << cases[i].what;
        } else {
            EXPECT_NEAR(hits[i].t / cases[i].t, 1, 2e-6) << cases[i].what;
        }
        EXPECT_EQ(any[i].triangle == ~0u, std::isinf(cases[i].t)) << cases[i].what;
    }
}

TEST_F(TraceTest, TheLongestListThatASoftwareDeviceTakesIsTracedToItsEnd) {
    // Triangles beside each other in one voxel: the last of the list is hit by one ray only.
    Geometry g;
    const auto add = [&](const glm::vec3& at) {
        const uint32_t first = uint32_t(g.positions.size());
        for (const glm::vec3& corner : {glm::vec3(0), glm::vec3(0.1f, 0, 0), glm::vec3(0, 0.1f, 0)})
            g.positions.push_back(at + corner);
        g.triangles.push_back({first, first + 1, first + 2});
    };
    g.upper = glm::vec3(10);
    for (int i = 0; i < 15'998; i++) add(glm::vec3(5.1f));
    add(glm::vec3(5.3f, 5.1f, 5.1f));
    TracedBody scene(device(), g, 16, HitTest::exact);
    const std::vector<Ray> rays = {{{5.12f, 5.12f, 0}, 0, {0, 0, 1}, kInfinity},
                                   {{5.32f, 5.12f, 0}, 0, {0, 0, 1}, kInfinity}};
    const auto hits = scene.trace(rays);
    EXPECT_LT(hits[0].triangle, 15'998u);
    EXPECT_EQ(hits[1].triangle, 15'998u);
    EXPECT_NEAR(hits[1].t, 5.1f, 1e-5f);
}

TEST_F(TraceTest, SkippedTriangleDoesNotCount) {
    TracedBody scene(device(), box_geometry(), 32, HitTest::exact);
    const std::vector<Ray> rays(2, Ray{{0.3f, -0.2f, -5}, 0, {0, 0, 1}, kInfinity});
    const auto first = scene.trace(rays);
    ASSERT_NE(first[0].triangle, ~0u);
    const auto hits = scene.trace(rays, false, {~0u, first[0].triangle});
    EXPECT_EQ(hits[0].triangle, first[0].triangle);
    EXPECT_FLOAT_EQ(hits[1].t, 6);
}

TEST_F(TraceTest, BarycentricWeightsGiveTheHitPoint) {
    const Geometry geometry = flatten(load_scene("builtin:blob:5000"));
    TracedBody scene(device(), geometry, 128, HitTest::exact);
    test::RaySource source(geometry, 5);
    std::vector<Ray> rays(20'000);
    for (Ray& ray : rays) ray = source.make(RayKind::uniform);
    const auto hits = scene.trace(rays);
    for (size_t i = 0; i < rays.size(); i++) {
        if (hits[i].triangle == ~0u) continue;
        const glm::uvec3 t = geometry.triangles[hits[i].triangle];
        const glm::vec3 p = geometry.positions[t.x] * (1 - hits[i].u - hits[i].v) +
                            geometry.positions[t.y] * hits[i].u + geometry.positions[t.z] * hits[i].v;
        EXPECT_LT(glm::length(p - (rays[i].origin + hits[i].t * rays[i].direction)), 2e-5f);
    }
}

TEST_F(TraceTest, PlanarHitsAreOffByLessThanAVoxel) {
    // Allowed are 0.3 % of hits off by more than one voxel at 1024; rays start off the surface.
    const Geometry geometry = flatten(load_scene("builtin:blob:300000"));
    TracedBody scene(device(), geometry, 1024, HitTest::planar);
    const Oracle oracle(geometry);
    test::RaySource source(geometry, 9);
    std::vector<Ray> rays(test::effort(50'000, 200'000));
    for (Ray& ray : rays) ray = source.make(RayKind::uniform);
    const auto hits = scene.trace(rays);
    std::atomic<size_t> off{0}, hit{0};
    parallel_for(rays.size(), [&](size_t i) {
        const OracleHit right = oracle.closest(oracle_ray(rays[i]));
        if (right.hit()) hit++;
        const double error = std::abs(right.t - double(hits[i].t)) * glm::length(glm::dvec3(rays[i].direction));
        const bool same = !right.hit() && hits[i].triangle == ~0u;
        // Across the surface: along a grazing ray a voxel's error is far more than a voxel.
        double cosine = 1;
        if (right.hit()) {
            const glm::uvec3 t = geometry.triangles[right.triangle];
            const glm::dvec3 a = geometry.positions[t.x];
            const glm::dvec3 n =
                glm::cross(glm::dvec3(geometry.positions[t.y]) - a, glm::dvec3(geometry.positions[t.z]) - a);
            cosine = std::abs(glm::dot(glm::normalize(n), glm::normalize(glm::dvec3(rays[i].direction))));
        }
        if (!same && !(error * cosine <= scene.grid().voxel)) off++;
    });
    fmt::print("  planar 1024: {} of {} off by more than a voxel\n", off.load(), hit.load());
    EXPECT_LE(double(off), 0.003 * double(hit));
}

}  // namespace
}  // namespace peelray
