// The oracle against a loop over all triangles, closed forms, and rays that are none.
#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "meshes.h"

namespace peelray {
namespace {

const double nan = std::numeric_limits<double>::quiet_NaN();

/// Rays through vertices, edges and triangles, along axes, in planes, from far away, with every length of direction.
OracleRay random_ray(RandomPoints& random, const Geometry& geometry, const glm::dvec3& center, double scale) {
    OracleRay ray{center + scale * random.point(1.5), 0, random.point(1), infinity};
    const glm::uvec3 t = geometry.triangles[random.below(uint32_t(geometry.triangles.size()))];
    const glm::dvec3 a(geometry.positions[t.x]), b(geometry.positions[t.y]), c(geometry.positions[t.z]);
    switch (random.below(10)) {
        case 0:
            ray.direction = a - ray.origin;
            break;
        case 1:
            ray.direction = glm::mix(a, b, random.uniform(0, 1)) - ray.origin;
            break;
        case 2:
            ray.direction = (a + b + c) / 3.0 - ray.origin;
            break;
        case 3:  // along an axis, through a vertex
            ray.direction = glm::dvec3(0);
            ray.direction[int(random.below(3))] = random.uniform(-1, 1);
            ray.origin = a - 3 * scale * ray.direction;
            break;
        case 4:  // in the triangle's own plane
            ray.direction = random.uniform(-1, 1) * (b - a) + random.uniform(-1, 1) * (c - a);
            ray.origin = a - 2.0 * ray.direction;
            if (ray.direction == glm::dvec3(0)) ray.direction.x = 1;
            break;
        case 5:  // grazing it
            ray.direction = (b - a) + scale * random.point(1e-6);
            ray.origin = (a + b + c) / 3.0 - 2.0 * ray.direction;
            break;
        case 6:  // from far away
            ray.origin = center + scale * random.point(std::pow(10, random.uniform(0, 7)));
            ray.direction = (a + b + c) / 3.0 - ray.origin;
            break;
        case 7:  // a piece of a ray, both signs of t
            ray.tmin = random.uniform(-2, 1) * scale;
            ray.tmax = ray.tmin + random.uniform(0, 2) * scale;
            break;
        case 8:
            ray.direction *= std::pow(10, random.uniform(-250, 250));
            break;
        default:
            break;
    }
    return ray;
}

void expect_as_brute_force(const Geometry& geometry, const Oracle& oracle, const OracleRay& ray, uint32_t skip) {
    const OracleHit fast = oracle.closest(ray, skip), slow = closest_brute_force(geometry, ray, skip);
    ASSERT_EQ(fast.triangle, slow.triangle) << fast.t << " " << slow.t;
    ASSERT_EQ(fast.t, slow.t);
    ASSERT_EQ(fast.u, slow.u);
    ASSERT_EQ(fast.v, slow.v);
    if (skip == ~0u) {
        ASSERT_EQ(oracle.check_any(ray, slow.hit()), Verdict::same);
    }
}

TEST(Oracle, EqualsTheLoopOverAllTriangles) {
    struct Case {
        glm::vec3 center;
        float scale;
    };
    size_t hits = 0;
    for (const Case& c : {Case{glm::vec3(0), 1},
                          {{1000, -2000, 500}, 1},
                          {{0, 1e6f, 0}, 10},
                          {glm::vec3(0), 1e-18f},
                          {glm::vec3(0), 1e18f}}) {
        const Geometry geometry = soup(800, 7, c.center, c.scale);
        const Oracle oracle(geometry);
        RandomPoints random(11);
        for (int i = 0; i < 10000; ++i) {
            SCOPED_TRACE(testing::Message() << "center " << c.center.x << ", scale " << c.scale << ", ray " << i);
            const OracleRay ray = random_ray(random, geometry, c.center, c.scale);
            const OracleHit first = oracle.closest(ray);
            hits += first.hit();
            expect_as_brute_force(geometry, oracle, ray, i % 3 == 0 ? first.triangle : ~0u);
            if (HasFatalFailure()) return;
        }
    }
    EXPECT_GT(hits, 20000u);
}

/// A scene whose only material has holes, and whose geometry is `geometry` with random texture coordinates.
Scene with_holes(Geometry& geometry) {
    Scene scene;
    scene.materials.emplace_back();
    scene.materials[0].alpha_cutoff = 0.5f;
    scene.materials[0].base_color_texture = 0;
    Texture texture;
    texture.width = texture.height = 16;
    RandomPoints random(3);
    for (int i = 0; i < 256; i++) texture.texels.push_back(uint32_t(128 + 127 * random.point(1).x) << 24);
    scene.textures.push_back(texture);
    geometry.materials.assign(geometry.triangles.size(), 0);
    for (size_t i = 0; i < geometry.positions.size(); i++) geometry.uvs.emplace_back(glm::vec2(random.point(2)));
    return scene;
}

TEST(Oracle, HitsInHolesDoNotCount) {
    Geometry geometry = soup(800, 7);
    const Scene scene = with_holes(geometry);
    const AlphaTest alpha(scene, geometry);
    const Oracle oracle(geometry, alpha), opaque(geometry);
    RandomPoints random(11);
    size_t through = 0, hits = 0, asked = 0, refused = 0;
    for (int i = 0; i < 10000; ++i) {
        const OracleRay ray = random_ray(random, geometry, glm::vec3(0), 1);
        const OracleHit fast = oracle.closest(ray), slow = closest_brute_force(geometry, ray, ~0u, alpha),
                        whole = opaque.closest(ray);
        ASSERT_EQ(fast.triangle, slow.triangle);
        ASSERT_EQ(fast.t, slow.t);
        ASSERT_GE(fast.t, whole.t);
        ASSERT_EQ(oracle.check(ray, slow.t, slow.triangle), Verdict::same);
        ASSERT_EQ(oracle.check_any(ray, slow.hit()), Verdict::same);
        hits += fast.hit();
        if (!fast.hit()) continue;
        ASSERT_TRUE(alpha.is_present(fast.triangle, fast.u, fast.v));
        if (fast.triangle == whole.triangle) continue;
        // What lies before it is a hole; who does not see it is wrong, unless its edge is near.
        ASSERT_FALSE(alpha.is_present(whole.triangle, whole.u, whole.v));
        through++;
        if (through % 10 == 0 && fast.t > 1.01 * whole.t) {
            asked++;
            refused += oracle.check(ray, whole.t, whole.triangle) == Verdict::wrong;
        }
    }
    EXPECT_GT(hits, 3000u);
    EXPECT_GT(through, 500u);
    EXPECT_GE(refused, asked * 4 / 5);  // some of the rays are aimed at edges
    EXPECT_GT(asked, 50u);
}

TEST(Oracle, HitsOnBacksDoNotCount) {
    Geometry geometry = soup(800, 7);
    Scene scene;
    scene.materials.resize(2);
    scene.materials[1].double_sided = false;
    for (size_t i = 0; i < geometry.triangles.size(); i++) geometry.materials.push_back(i % 3 ? 1 : 0);
    const Sidedness sides(scene, geometry);
    const Oracle oracle(geometry, {}, sides), both(geometry);
    RandomPoints random(11);
    size_t through = 0;
    for (int i = 0; i < 10000; ++i) {
        const OracleRay ray = random_ray(random, geometry, glm::vec3(0), 1);
        const OracleHit fast = oracle.closest(ray), slow = closest_brute_force(geometry, ray, ~0u, {}, sides),
                        whole = both.closest(ray);
        ASSERT_EQ(fast.triangle, slow.triangle);
        ASSERT_EQ(fast.t, slow.t);
        ASSERT_EQ(oracle.check(ray, slow.t, slow.triangle), Verdict::same);
        ASSERT_EQ(oracle.check_any(ray, slow.hit()), Verdict::same);
        const auto normal = [&](uint32_t triangle) {
            const glm::uvec3 t = geometry.triangles[triangle];
            const glm::dvec3 a = geometry.positions[t.x];
            return glm::cross(glm::dvec3(geometry.positions[t.y]) - a, glm::dvec3(geometry.positions[t.z]) - a);
        };
        if (fast.hit() && fast.triangle % 3) {
            ASSERT_LT(glm::dot(normal(fast.triangle), ray.direction), 0);
        }
        if (fast.triangle == whole.triangle) continue;
        ASSERT_TRUE(whole.triangle % 3);
        ASSERT_GE(glm::dot(normal(whole.triangle), ray.direction), 0);
        through++;
    }
    EXPECT_GT(through, 1000u);
}

TEST(Oracle, AnAnswerBesideAHolesEdgeIsRight) {
    // Half a square is there: x below 0.5.
    Geometry geometry;
    geometry.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    geometry.triangles = {{0, 1, 2}, {0, 2, 3}};
    geometry.materials = {0, 0};
    for (const glm::vec3& p : geometry.positions) geometry.colors.emplace_back(1, 1, 1, 1 - p.x);
    geometry.uvs.resize(4);
    Scene scene;
    scene.materials.emplace_back();
    scene.materials[0].alpha_cutoff = 0.5f;
    const Oracle oracle(geometry, AlphaTest(scene, geometry));
    const auto at = [](double x) { return OracleRay{{x, 0.3, 1}, 0, {0, 0, -1}, infinity}; };
    EXPECT_TRUE(oracle.closest(at(0.499)).hit());
    EXPECT_FALSE(oracle.closest(at(0.501)).hit());
    EXPECT_EQ(oracle.check(at(0.499999), infinity, ~0u), Verdict::within_offset);
    EXPECT_EQ(oracle.check(at(0.502), 1, 0), Verdict::wrong);
    EXPECT_EQ(oracle.check(at(0.498), infinity, ~0u), Verdict::wrong);
    EXPECT_EQ(oracle.check_any(at(0.499999), false), Verdict::within_offset);
    EXPECT_EQ(oracle.check_any(at(0.498), false), Verdict::wrong);
    EXPECT_EQ(oracle.check_any(at(0.502), true), Verdict::wrong);
}

/// An intersection of another kind: signed volumes in extended precision. It must agree wherever it is sure.
TEST(Oracle, AgreesWithSignedVolumes) {
    const Geometry geometry = soup(300, 3);
    const Oracle oracle(geometry);
    RandomPoints random(5);
    using Vec = glm::vec<3, long double>;
    const auto volume = [](const Vec& a, const Vec& b, const Vec& c) { return glm::dot(glm::cross(a, b), c); };
    for (int i = 0; i < 10000; ++i) {
        const OracleRay ray{random.point(1.5), 0, random.point(1), infinity};
        OracleHit nearest{infinity, ~0u, 0, 0};
        bool sure = true;
        for (uint32_t k = 0; k < geometry.triangles.size(); ++k) {
            const glm::uvec3 t = geometry.triangles[k];
            const Vec o(ray.origin), d(ray.direction);
            const Vec a = Vec(geometry.positions[t.x]) - o, b = Vec(geometry.positions[t.y]) - o,
                      c = Vec(geometry.positions[t.z]) - o;
            const long double u = volume(c, b, d), v = volume(a, c, d), w = volume(b, a, d), sum = u + v + w;
            if (u * sum < 0 || v * sum < 0 || w * sum < 0 || sum == 0) continue;
            const long double distance = -volume(a, b, c) / sum;
            if (std::min({u / sum, v / sum, w / sum}) < 1e-12L || std::abs(distance - (long double)nearest.t) < 1e-12L)
                sure = false;
            if (distance > 0 && distance < (long double)nearest.t)
                nearest = {double(distance), k, double(v / sum), double(w / sum)};
        }
        const OracleHit hit = oracle.closest(ray);
        if (!sure) continue;
        ASSERT_EQ(hit.triangle, nearest.triangle) << i;
        if (!hit.hit()) continue;
        // A sliver's own conditioning: its plane is known to about an ulp over its width.
        ASSERT_NEAR(hit.t, nearest.t, 1e-7 * nearest.t + 1e-9) << i;
        const glm::uvec3 t = geometry.triangles[hit.triangle];
        const glm::dvec3 a(geometry.positions[t.x]), b(geometry.positions[t.y]), c(geometry.positions[t.z]);
        const glm::dvec3 there = a * (1 - hit.u - hit.v) + b * hit.u + c * hit.v;
        ASSERT_LT(glm::length(there - (ray.origin + hit.t * ray.direction)), 1e-9) << i;
    }
}

TEST(Oracle, RaysThatAreNoneMiss) {
    const Oracle oracle(cube());
    const OracleRay good{{0.3, 0.2, -5}, 0, {0, 0, 1}, infinity};
    ASSERT_EQ(oracle.closest(good).t, 4);
    const auto misses = [&](auto change) {
        OracleRay ray = good;
        change(ray);
        const OracleHit hit = oracle.closest(ray);
        EXPECT_FALSE(hit.hit());
        EXPECT_EQ(hit.t, infinity);
        EXPECT_EQ(oracle.check_any(ray, false), Verdict::same);
        EXPECT_EQ(oracle.check_any(ray, true), Verdict::wrong);
        EXPECT_EQ(oracle.check(ray, infinity, ~0u), Verdict::same);
        EXPECT_EQ(oracle.check(ray, 4, 8), Verdict::wrong);
    };
    misses([](OracleRay& ray) { ray.direction = glm::dvec3(0); });
    misses([](OracleRay& ray) { ray.tmin = 3, ray.tmax = 2; });
    misses([](OracleRay& ray) { ray.tmin = ray.tmax = 4; });
    for (const double bad : {nan, infinity, -infinity})
        for (int i = 0; i < 3; ++i) {
            misses([&](OracleRay& ray) { ray.origin[i] = bad; });
            misses([&](OracleRay& ray) { ray.direction[i] = bad; });
        }
    misses([](OracleRay& ray) { ray.tmin = nan; });
    misses([](OracleRay& ray) { ray.tmax = nan; });
    misses([](OracleRay& ray) { ray.tmin = infinity; });
    misses([](OracleRay& ray) { ray.tmax = -infinity; });
}

TEST(Oracle, TheRangeIsOpen) {
    const Oracle oracle(cube());
    OracleRay ray{{0.3, 0.2, -5}, 4, {0, 0, 1}, 6};
    EXPECT_FALSE(oracle.closest(ray).hit());
    ray.tmin = std::nextafter(4.0, 0.0);
    EXPECT_EQ(oracle.closest(ray).t, 4);
    ray.tmin = 4;
    ray.tmax = std::nextafter(6.0, 7.0);
    EXPECT_EQ(oracle.closest(ray).t, 6);
    ray.tmin = -infinity;
    EXPECT_EQ(oracle.closest(ray).t, 4);
}

TEST(Oracle, CubeInClosedForm) {
    const Oracle oracle(cube());
    EXPECT_DOUBLE_EQ(oracle.diagonal(), std::sqrt(12.0));
    RandomPoints random(1);
    for (int i = 0; i < 20000; ++i) {
        const OracleRay ray{random.point(4), 0, random.point(1), infinity};
        double first = -infinity, last = infinity;
        for (int k = 0; k < 3; ++k) {
            const double a = (-1 - ray.origin[k]) / ray.direction[k], b = (1 - ray.origin[k]) / ray.direction[k];
            first = std::max(first, std::min(a, b));
            last = std::min(last, std::max(a, b));
        }
        const bool hit = first < last && last > 0;
        const OracleHit found = oracle.closest(ray);
        ASSERT_EQ(found.hit(), hit) << i;
        if (!hit) continue;
        ASSERT_NEAR(found.t, first > 0 ? first : last, 1e-12 * (1 + found.t)) << i;
    }
}

/// Edges and vertices belong to the solid: no ray slips through a closed mesh.
TEST(Oracle, AClosedMeshIsWatertight) {
    const Geometry mesh = sphere(40);
    const Oracle oracle(mesh);
    RandomPoints random(2);
    for (int i = 0; i < 30000; ++i) {
        const glm::uvec3 t = mesh.triangles[random.below(uint32_t(mesh.triangles.size()))];
        const glm::dvec3 a(mesh.positions[t.x]), b(mesh.positions[t.y]);
        OracleRay ray{random.point(0.5), 0, {}, infinity};
        ray.direction = (i % 3 == 0 ? a : glm::mix(a, b, random.uniform(0, 1))) - ray.origin;
        const OracleHit hit = oracle.closest(ray);
        ASSERT_TRUE(hit.hit()) << i;
        const glm::dvec3 point = ray.origin + hit.t * ray.direction;
        const double sagitta = 1 - std::cos(std::numbers::pi / 40);
        ASSERT_LE(glm::length(point), 1 + 1e-7);
        ASSERT_GE(glm::length(point), 1 - 2 * sagitta);
    }
}

/// From 2⁴⁵ away, where rounding in the shear alone would be 10⁻²: all numbers here are exact, so the aim is, too.
TEST(Oracle, DistantOriginsKeepTheirAim) {
    const Geometry mesh = cube();
    const Oracle oracle(mesh);
    const glm::dvec3 direction(0.5, 0.25, 0.75), target(-1, 0.1875, 0.3125);
    const double distance = 0x1p45;
    const OracleRay ray{target - distance * direction, 0, direction, infinity};
    const OracleHit hit = oracle.closest(ray);
    ASSERT_TRUE(hit.hit());
    EXPECT_NEAR(hit.t, distance, 0.02);  // two ulps
    const glm::uvec3 t = mesh.triangles[hit.triangle];
    const glm::dvec3 a(mesh.positions[t.x]), b(mesh.positions[t.y]), c(mesh.positions[t.z]);
    EXPECT_LT(glm::length(a * (1 - hit.u - hit.v) + b * hit.u + c * hit.v - target), 1e-14);
    EXPECT_EQ(oracle.check(ray, hit.t, hit.triangle), Verdict::same);
}

/// Deep BVHs and small triangles; few rays, since the loop is slow.
TEST(Oracle, EqualsTheLoopOnAFineMesh) {
    const Geometry mesh = sphere(120);
    const Oracle oracle(mesh);
    RandomPoints random(8);
    for (int i = 0; i < 500; ++i) {
        SCOPED_TRACE(i);
        expect_as_brute_force(mesh, oracle, random_ray(random, mesh, {}, 1), ~0u);
        if (HasFatalFailure()) return;
    }
}

TEST(Oracle, SkipAndTiesAndBarycentrics) {
    Geometry geometry;
    add_triangle(geometry, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    add_triangle(geometry, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    add_triangle(geometry, {0, 0, 1}, {1, 0, 1}, {0, 1, 1});
    const Oracle oracle(geometry);
    const OracleRay ray{{0.25, 0.5, -1}, 0, {0, 0, 2}, infinity};
    const OracleHit hit = oracle.closest(ray);
    EXPECT_EQ(hit.triangle, 0u);
    EXPECT_EQ(hit.t, 0.5);
    EXPECT_EQ(hit.u, 0.25);
    EXPECT_EQ(hit.v, 0.5);
    EXPECT_EQ(oracle.closest(ray, 0).triangle, 1u);
    EXPECT_EQ(oracle.closest(ray, 1).triangle, 0u);
}

TEST(Oracle, ScenesWithoutSurface) {
    Geometry points;
    add_triangle(points, {1, 1, 1}, {1, 1, 1}, {1, 1, 1});
    add_triangle(points, {0, 0, 0}, {1, 1, 1}, {2, 2, 2});
    for (const Geometry& geometry : {Geometry{}, points}) {
        const Oracle oracle(geometry);
        const OracleRay ray{{1, 1, -1}, 0, {0, 0, 1}, infinity};
        EXPECT_FALSE(oracle.closest(ray).hit());
        EXPECT_EQ(oracle.check(ray, infinity, ~0u), Verdict::same);
        EXPECT_EQ(oracle.check(ray, 2, 0), Verdict::wrong);
    }
}

TEST(Oracle, IgnoresWhatIsNoTriangle) {
    Geometry geometry = cube();
    add_triangle(geometry, {0, 0, float(nan)}, {1, 0, 0}, {0, 1, 0});
    add_triangle(geometry, {0, 0, std::numeric_limits<float>::infinity()}, {1, 0, 0}, {0, 1, 0});
    geometry.triangles.emplace_back(0, 1, 1000000);
    const Oracle oracle(geometry);
    EXPECT_DOUBLE_EQ(oracle.diagonal(), std::sqrt(12.0));
    EXPECT_EQ(oracle.closest({{0.3, 0.2, -5}, 0, {0, 0, 1}, infinity}).t, 4);
}

TEST(Oracle, ManyThreadsGetTheSameAnswers) {
    const Geometry geometry = soup(2000, 9);
    const Oracle oracle(geometry);
    std::vector<OracleRay> rays;
    std::vector<OracleHit> expected;
    RandomPoints random(4);
    for (int i = 0; i < 5000; ++i) rays.push_back(random_ray(random, geometry, {}, 1));
    for (const OracleRay& ray : rays) expected.push_back(oracle.closest(ray));
    std::atomic<int> different{0};
    std::vector<std::thread> threads;
    for (int k = 0; k < 4; ++k)
        threads.emplace_back([&] {
            for (size_t i = 0; i < rays.size(); ++i) {
                const OracleHit hit = oracle.closest(rays[i]);
                different += hit.triangle != expected[i].triangle || hit.t != expected[i].t;
            }
        });
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(different, 0);
}

}  // namespace
}  // namespace peelray
