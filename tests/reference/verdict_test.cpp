// What counts as right (docs/accuracy.md, "Rays").
#include <gtest/gtest.h>

#include "meshes.h"

namespace peelray {
namespace {

constexpr uint32_t none = ~0u;

/// The cube's diagonal is 3.46: offsets up to 6.9e-6, differences across the surface up to 3.46e-5.
TEST(Verdict, ExactAnswersAreTheSame) {
    const Oracle oracle(cube());
    const OracleRay ray{{0.3, 0.2, -5}, 0, {0, 0, 2}, infinity};
    EXPECT_EQ(oracle.check(ray, 2, 8), Verdict::same);
    EXPECT_EQ(oracle.check(ray, 2, 9), Verdict::same) << "triangles need not match";
    EXPECT_EQ(oracle.check(ray, 2 + 1.7e-5, 8), Verdict::same) << "t counts in lengths of the direction";
    EXPECT_EQ(oracle.check(ray, 2 - 1.7e-5, 8), Verdict::same);
    EXPECT_EQ(oracle.check({{3, 0, -5}, 0, {0, 0, 2}, infinity}, infinity, none), Verdict::same);
}

TEST(Verdict, WrongAnswersAreWrong) {
    const Oracle oracle(cube());
    const OracleRay ray{{0.3, 0.2, -5}, 0, {0, 0, 2}, infinity};
    EXPECT_EQ(oracle.check(ray, 3, 10), Verdict::wrong) << "the back face";
    EXPECT_EQ(oracle.check(ray, 2.001, 8), Verdict::wrong);
    EXPECT_EQ(oracle.check(ray, infinity, none), Verdict::wrong);
    EXPECT_EQ(oracle.check(ray, 2, 12), Verdict::wrong) << "no such triangle";
    EXPECT_EQ(oracle.check(ray, 2, none), Verdict::wrong) << "a hit without a triangle";
    EXPECT_EQ(oracle.check(ray, infinity, 8), Verdict::wrong) << "a miss with a triangle";
    EXPECT_EQ(oracle.check(ray, std::nan(""), 8), Verdict::wrong);
    EXPECT_EQ(oracle.check(ray, -infinity, 8), Verdict::wrong);
    EXPECT_EQ(oracle.check({{3, 0, -5}, 0, {0, 0, 2}, infinity}, 2, 8), Verdict::wrong);
    EXPECT_EQ(oracle.check_any(ray, false), Verdict::wrong);
    EXPECT_EQ(oracle.check_any({{3, 0, -5}, 0, {0, 0, 2}, infinity}, true), Verdict::wrong);
}

TEST(Verdict, AtASilhouetteBothAnswersAreRight) {
    const Oracle oracle(cube());
    for (const double distance : {1e-12, 1e-9, 1e-7, 5e-6}) {
        const OracleRay outside{{1 + distance, 0.2, -5}, 0, {0, 0, 1}, infinity};
        EXPECT_EQ(oracle.check(outside, infinity, none), Verdict::same);
        EXPECT_EQ(oracle.check(outside, 4, 8), Verdict::within_offset) << distance;
        EXPECT_EQ(oracle.check_any(outside, true), Verdict::within_offset) << distance;
        const OracleRay inside{{1 - distance, 0.2, -5}, 0, {0, 0, 1}, infinity};
        EXPECT_EQ(oracle.check(inside, 4, 8), Verdict::same);
        EXPECT_EQ(oracle.check(inside, infinity, none), Verdict::within_offset) << distance;
        EXPECT_EQ(oracle.check_any(inside, false), Verdict::within_offset) << distance;
    }
    const OracleRay outside{{1 + 8e-6, 0.2, -5}, 0, {0, 0, 1}, infinity};
    EXPECT_EQ(oracle.check(outside, 4, 8), Verdict::wrong);
    EXPECT_EQ(oracle.check_any(outside, true), Verdict::wrong);
}

TEST(Verdict, EndsOfTheRayHaveTheSameLeeway) {
    const Oracle oracle(cube());
    const OracleRay behind{{0.3, 0.2, -5}, 4 + 1e-6, {0, 0, 1}, infinity};  // starts just inside: sees the back face
    EXPECT_EQ(oracle.check(behind, 6, 10), Verdict::same);
    EXPECT_EQ(oracle.check(behind, 4 + 1e-6, 8), Verdict::within_offset);
    const OracleRay before{{0.3, 0.2, -5}, 0, {0, 0, 1}, 4 - 1e-6};
    EXPECT_EQ(oracle.check(before, infinity, none), Verdict::same);
    EXPECT_EQ(oracle.check(before, 4, 8), Verdict::within_offset);
    EXPECT_EQ(oracle.check_any(before, true), Verdict::within_offset);
    const OracleRay reaching{{0.3, 0.2, -5}, 0, {0, 0, 1}, 4 + 1e-6};
    EXPECT_EQ(oracle.check(reaching, infinity, none), Verdict::within_offset);
    EXPECT_EQ(oracle.check_any(reaching, false), Verdict::within_offset);
    const OracleRay short_of{{0.3, 0.2, -5}, 0, {0, 0, 1}, 4 - 1e-4};
    EXPECT_EQ(oracle.check(short_of, 4, 8), Verdict::wrong);
    EXPECT_EQ(oracle.check_any(short_of, true), Verdict::wrong);
}

/// At a grazing angle a tiny distance across the surface is a long way along the ray.
TEST(Verdict, DifferencesCountAcrossTheSurface) {
    const Oracle oracle(cube());
    const double slope = 1e-3;
    const OracleRay ray{{0, 0.2, -1.001}, 0, {1, 0, 2 * slope}, infinity};
    const double t = 0.001 / (2 * slope);
    EXPECT_EQ(oracle.check(ray, t, 8), Verdict::same);
    EXPECT_EQ(oracle.check(ray, t + 0.01, 8), Verdict::same);
    EXPECT_EQ(oracle.check(ray, t + 0.03, 8), Verdict::wrong);
}

/// Thinner than any grid of offsets: only the search along edges finds it.
TEST(Verdict, FindsASliverBesideTheRay) {
    Geometry geometry = cube();
    add_triangle(geometry, {-0.5f, 0, -2}, {0.5f, 0, -2}, {0.5f, 1e-11f, -2});
    const Oracle oracle(geometry);
    const OracleRay ray{{0.123, 3e-6, -5}, 0, {0, 0, 1}, infinity};
    EXPECT_EQ(oracle.check(ray, 4, 8), Verdict::same);
    EXPECT_EQ(oracle.check(ray, 3, 12), Verdict::within_offset);
    const OracleRay farther{{0.123, 2e-5, -5}, 0, {0, 0, 1}, infinity};
    EXPECT_EQ(oracle.check(farther, 3, 12), Verdict::wrong);
    const OracleRay on_it{{0.4, 0, -5}, 0, {0, 0, 1}, infinity};
    EXPECT_EQ(oracle.check(on_it, 3, 12), Verdict::same);
    EXPECT_EQ(oracle.check(on_it, 4, 8), Verdict::within_offset);
}

/// What a single-precision tracer would answer, rounded, on a mesh of many triangles: never wrong; answers of another
/// ray: nearly always.
TEST(Verdict, SeparatesRoundingFromErrors) {
    const Geometry mesh = sphere(60);
    const Oracle oracle(mesh);
    RandomPoints random(6);
    size_t second_look = 0, wrong = 0, lies = 0;
    for (int i = 0; i < 20000; ++i) {
        const glm::uvec3 t = mesh.triangles[random.below(uint32_t(mesh.triangles.size()))];
        OracleRay ray{glm::dvec3(glm::vec3(random.point(2))), 0, {}, infinity};
        ray.direction = glm::dvec3(mesh.positions[t.x]) + (i % 2 ? glm::dvec3(0) : random.point(0.5)) - ray.origin;
        ray.direction = glm::dvec3(glm::vec3(ray.direction));
        OracleRay shaken = ray;
        shaken.origin += random.point(5e-7);
        const OracleHit hit = oracle.closest(shaken);
        const Verdict verdict = oracle.check(ray, double(float(hit.t)), hit.triangle);
        second_look += verdict == Verdict::within_offset;
        wrong += verdict == Verdict::wrong;
        if (hit.hit())
            lies += oracle.check(ray, hit.t * 1.01, hit.triangle) == Verdict::wrong;
        else
            lies += oracle.check(ray, 1, 0) == Verdict::wrong;
    }
    EXPECT_EQ(wrong, 0u);
    EXPECT_LT(second_look, 2000u);
    EXPECT_GT(lies, 19000u);
}

TEST(Verdict, HoldsAtAnyScaleAndPlace) {
    for (const float scale : {1e-15f, 1.0f, 1e15f}) {
        Geometry geometry = cube();
        for (glm::vec3& position : geometry.positions) position *= scale;
        const Oracle oracle(geometry);
        const OracleRay outside{glm::dvec3(1 + 3e-6, 0.2, -5) * double(scale), 0, {0, 0, 1e-9}, infinity};
        EXPECT_EQ(oracle.check(outside, 4e9 * scale, 8), Verdict::within_offset);
        EXPECT_EQ(oracle.check(outside, 5e9 * scale, 8), Verdict::wrong);
        EXPECT_EQ(oracle.check(outside, infinity, none), Verdict::same);
    }
}

}  // namespace
}  // namespace peelray
