// Ray against triangle, in single and in doubled precision, against double; no ray slips through between two triangles.
#include "probe_fixture.h"

namespace peelray {
namespace {

using glm::dvec2;
using glm::dvec3;
using glm::vec3;

struct Ray3 {
    vec3 origin, direction, a, b, c;
};
struct Result {
    uint32_t fast;  ///< bit 0: inside, bit 1: uncertain
    float fast_t;
    glm::vec2 fast_uv;
    uint32_t precise;
    float t;
    glm::vec2 uv;

    bool single() const { return fast & 1; }  ///< what single precision alone says
    bool certain() const { return !(fast & 2); }
    bool hit() const { return certain() ? single() : precise; }  ///< what the traversal makes of it
};

class IntersectProbe : public ProbeTest {
  protected:
    std::vector<Result> run(const std::vector<Ray3>& rays) { return probe<Result>("probe_intersect", rays); }
};

/// Solves origin + t·direction = a + u·(b - a) + v·(c - a) by Cramer's rule.
dvec3 solve(const Ray3& r) {
    const dvec3 e = dvec3(r.b) - dvec3(r.a), f = dvec3(r.c) - dvec3(r.a), d = r.direction,
                s = dvec3(r.origin) - dvec3(r.a);
    const double det = glm::dot(glm::cross(e, f), -d);
    return {glm::dot(glm::cross(e, f), s) / det, glm::dot(glm::cross(s, f), -d) / det,
            glm::dot(glm::cross(e, s), -d) / det};
}

TEST_F(IntersectProbe, AgreesWithDoublePrecision) {
    std::vector<Ray3> rays;
    for (int i = 0; i < 60000; i++) {
        Ray3 r{point(-3, 3), point(-1, 1), point(-1, 1), point(-1, 1), point(-1, 1)};
        // Half of the rays are aimed at the triangle; some run along an axis, with zeros of both signs; some are long
        // or short.
        const dvec3 w(uniform(0, 1), uniform(0, 1), uniform(0, 1));
        if (i % 2)
            r.direction =
                vec3((dvec3(r.a) * w.x + dvec3(r.b) * w.y + dvec3(r.c) * w.z) / (w.x + w.y + w.z) - dvec3(r.origin));
        if (i % 10 == 2) r.direction[i / 10 % 3] = i % 20 == 2 ? 0.0f : -0.0f;
        if (i % 10 == 4) r.direction[i / 10 % 3] = r.direction[(i / 10 + 1) % 3] = 0;
        if (i % 10 == 6) r.direction *= 1e-10f;
        if (i % 10 == 8) r.direction *= 1e10f;
        rays.push_back(r);
    }
    const auto results = run(rays);
    int hits = 0, misses = 0, behind = 0, certain = 0;
    for (size_t i = 0; i < rays.size(); i++) {
        const Ray3& r = rays[i];
        const dvec3 e = dvec3(r.b) - dvec3(r.a), f = dvec3(r.c) - dvec3(r.a), n = glm::cross(e, f);
        const double grazing =
            std::abs(glm::dot(n, glm::normalize(dvec3(r.direction)))) / (glm::length(e) * glm::length(f));
        if (grazing < 1e-2) continue;
        const dvec3 x = solve(r);
        const double margin = std::min({x.y, x.z, 1 - x.y - x.z});
        if (std::abs(margin) < 1e-11 / grazing) continue;
        certain += results[i].certain();
        ASSERT_EQ(results[i].precise != 0, margin > 0) << i << " margin " << margin;
        ASSERT_TRUE(!results[i].certain() || results[i].single() == (margin > 0)) << i << " margin " << margin;
        if (margin < 0) {
            misses++;
            continue;
        }
        hits++;
        behind += x.x < 0;
        // Along the surface the tolerance grows with the grazing angle.
        const double t_tolerance = 1e-6 / grazing * (6 / glm::length(dvec3(r.direction)) + std::abs(x.x));
        ASSERT_NEAR(results[i].t, x.x, t_tolerance) << i;
        // Weights of the second and third corner, whatever the winding.
        ASSERT_NEAR(results[i].uv.x, x.y, 1e-6) << i;
        ASSERT_NEAR(results[i].uv.y, x.z, 1e-6) << i;
        if (!results[i].certain()) continue;
        ASSERT_NEAR(results[i].fast_t, x.x, 10 * t_tolerance) << i;
        ASSERT_NEAR(results[i].fast_uv.x, x.y, 1e-5 / grazing) << i;
        ASSERT_NEAR(results[i].fast_uv.y, x.z, 1e-5 / grazing) << i;
    }
    EXPECT_GT(certain, (hits + misses) * 95 / 100) << "single precision is to decide nearly always";
    EXPECT_GT(hits, 20000);
    EXPECT_GT(misses, 15000);
    EXPECT_GT(behind, 50) << "hits behind the origin have t < 0";
}

TEST_F(IntersectProbe, UvAreTheWeightsOfTheSecondAndThirdCorner) {
    const vec3 a(0, 0, 0), b(1, 0, 0), c(0, 1, 0);
    const auto results = run({{{0.5f, 0.25f, 2}, {0, 0, -1}, a, b, c},
                              {{0.5f, 0.25f, 2}, {0, 0, -1}, a, c, b},
                              {{0.5f, 0.25f, -1}, {0, 0, -1}, a, b, c}});
    for (const auto& r : results) EXPECT_TRUE(r.hit());
    EXPECT_EQ(results[0].uv, glm::vec2(0.5f, 0.25f));
    EXPECT_EQ(results[1].uv, glm::vec2(0.25f, 0.5f));
    EXPECT_EQ(results[0].t, 2);
    EXPECT_EQ(results[2].t, -1);
}

TEST_F(IntersectProbe, WhatSinglePrecisionDecidesNearEdgesIsRight) {
    // Rays within a few roundings of an edge, in scenes far from the origin: either answer of the fast test must be
    // true.
    std::vector<Ray3> rays;
    for (int i = 0; i < 60000; i++) {
        const vec3 centre = point(-1, 1) * float(std::exp2(uniform(0, 6)));
        Ray3 r{centre + point(-8, 8), {}, centre + point(-1, 1), centre + point(-1, 1), centre + point(-1, 1)};
        const double s = uniform(0, 1);
        const dvec3 aim = dvec3(r.a) * (1 - s) + dvec3(r.b) * s +
                          (dvec3(r.c) - dvec3(r.a)) * (uniform(-1, 1) * std::exp2(uniform(-24, -12)));
        r.direction = vec3(aim - dvec3(r.origin));
        rays.push_back(r);
    }
    const auto results = run(rays);
    size_t wrong = 0, decided = 0, checked = 0;
    for (size_t i = 0; i < rays.size(); i++) {
        const dvec3 x = solve(rays[i]);
        const double margin = std::min({x.y, x.z, 1 - x.y - x.z});
        if (!std::isfinite(margin) || std::abs(margin) < 1e-9) continue;
        checked++;
        decided += results[i].certain();
        wrong += (results[i].precise != 0) != (margin > 0) || results[i].hit() != (margin > 0);
    }
    EXPECT_EQ(wrong, 0u);
    EXPECT_GT(checked, 50000u);
    EXPECT_GT(decided, 5000u);
}

TEST_F(IntersectProbe, NoRaySlipsThroughASharedEdge) {
    std::vector<Ray3> rays;
    for (int i = 0; i < 100000; i++) {
        const double spread = i % 3 == 0 ? 1 : i % 3 == 1 ? 30 : 1e-2;
        const vec3 centre = point(-10, 10);
        const vec3 b = centre + point(-spread, spread), c = centre + point(-spread, spread);
        const double s = uniform(0.01, 0.99);
        const dvec3 aim = dvec3(b) * (1 - s) + dvec3(c) * s;
        const vec3 origin = centre + point(-40, 40);
        const vec3 direction = vec3((aim - dvec3(origin)) * uniform(0.1, 3));
        // The two other corners on either side of the edge as seen from the origin, in all windings.
        const dvec3 aside = glm::cross(aim - dvec3(origin), dvec3(c) - dvec3(b));
        const dvec3 unit_aside = glm::normalize(aside) * spread;
        const vec3 a = vec3(aim + unit_aside * uniform(0.3, 1.0) + (aim - dvec3(origin)) * uniform(-0.1, 0.1));
        const vec3 d = vec3(aim - unit_aside * uniform(0.3, 1.0) + (aim - dvec3(origin)) * uniform(-0.1, 0.1));
        const vec3 first[3][3] = {{a, b, c}, {b, c, a}, {c, a, b}};
        const vec3 second[6][3] = {{d, c, b}, {c, b, d}, {b, d, c}, {d, b, c}, {b, c, d}, {c, d, b}};
        const auto& f = first[bits() % 3];
        const auto& g = second[bits() % 6];
        rays.push_back({origin, direction, f[0], f[1], f[2]});
        rays.push_back({origin, direction, g[0], g[1], g[2]});
    }
    const auto results = run(rays);
    size_t leaks = 0, single_leaks = 0, only_one = 0;
    for (size_t i = 0; i < rays.size(); i += 2) {
        leaks += !results[i].hit() && !results[i + 1].hit();
        single_leaks += !results[i].single() && !results[i + 1].single();
        only_one += results[i].hit() != results[i + 1].hit();
    }
    EXPECT_EQ(leaks, 0u);
    EXPECT_EQ(single_leaks, 0u) << "single precision alone is watertight too";
    EXPECT_GT(only_one, 90000u) << "the rays are to tell the two sides apart";
}

TEST_F(IntersectProbe, NoRaySlipsThroughASharedCorner) {
    const int fan = 6, count = 15000;
    std::vector<Ray3> rays;
    for (int i = 0; i < count; i++) {
        const vec3 tip = point(-5, 5), origin = tip + point(-20, 20), direction = tip - origin;
        const dvec3 d = glm::normalize(dvec3(direction)), u = glm::normalize(glm::cross(d, dvec3(0.3, 0.5, 0.8))),
                    v = glm::cross(d, u);
        vec3 rim[fan];
        for (int k = 0; k < fan; k++) {
            const double phi = 2 * 3.14159265358979 * (k + uniform(0, 0.6)) / fan;
            rim[k] =
                vec3(dvec3(tip) + uniform(0.2, 2) * (u * std::cos(phi) + v * std::sin(phi)) + d * uniform(-0.3, 0.3));
        }
        for (int k = 0; k < fan; k++) rays.push_back({origin, direction, tip, rim[k], rim[(k + 1) % fan]});
    }
    const auto results = run(rays);
    size_t leaks = 0, single_leaks = 0;
    for (int i = 0; i < count; i++) {
        uint32_t hits = 0, single = 0;
        for (int k = 0; k < fan; k++) {
            hits += results[size_t(i * fan + k)].hit();
            single += results[size_t(i * fan + k)].single();
        }
        leaks += hits == 0;
        single_leaks += single == 0;
    }
    EXPECT_EQ(leaks, 0u);
    EXPECT_EQ(single_leaks, 0u) << "single precision alone is watertight too";
}

TEST_F(IntersectProbe, DegenerateTrianglesAreNeverHit) {
    std::vector<Ray3> rays;
    for (int i = 0; i < 20000; i++) {
        const vec3 a = point(-1, 1), b = point(-1, 1), origin = point(-3, 3);
        const double s = uniform(0, 1);
        const vec3 direction = vec3(dvec3(a) * (1 - s) + dvec3(b) * s - dvec3(origin));  // aimed at what is left of it
        const vec3 corners[4][3] = {{a, a, b}, {a, b, b}, {a, b, a}, {a, a, a}};
        rays.push_back({origin, direction, corners[i % 4][0], corners[i % 4][1], corners[i % 4][2]});
    }
    for (const auto& r : run(rays)) ASSERT_FALSE(r.hit());
}

TEST_F(IntersectProbe, ParallelRaysInFrontOfAPlaneMiss) {
    std::vector<Ray3> rays;
    for (int i = 0; i < 3000; i++) {
        Ray3 r{point(-1, 1), point(-1, 1), point(-1, 1), point(-1, 1), point(-1, 1)};
        const int axis = i % 3;
        r.a[axis] = r.b[axis] = r.c[axis] = 0.25f;
        r.direction[axis] = 0;
        if (r.origin[axis] == 0.25f) r.origin[axis] = 0.5f;
        rays.push_back(r);
    }
    for (const auto& r : run(rays)) ASSERT_TRUE(!r.hit() || !std::isfinite(r.t));
}

}  // namespace
}  // namespace peelray
