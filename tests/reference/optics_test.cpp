// The reference's optics against figures that stand in textbooks or follow from them by hand.
#include "reference/optics.h"

#include <gtest/gtest.h>

#include <cmath>

namespace peelray::optics {
namespace {

double degrees(double angle) {
    return angle * pi / 180;
}

TEST(Fresnel, KnownAngles) {
    EXPECT_NEAR(fresnel_dielectric(1, 1.5), 0.04, 1e-15);  // ((1.5 - 1) / (1.5 + 1))²
    EXPECT_NEAR(fresnel_dielectric(1, 1.33), std::pow(0.33 / 2.33, 2), 1e-15);
    EXPECT_NEAR(fresnel_dielectric(0, 1.5), 1, 1e-15);
    // Brewster's angle: no parallel part, and refracted and reflected ray at right angles, so that the rest is sin²(b -
    // t)/2 with b + t = 90°.
    const double brewster = std::atan(1.5);
    EXPECT_NEAR(fresnel_dielectric(std::cos(brewster), 1.5), std::pow(std::sin(2 * brewster - pi / 2), 2) / 2, 1e-14);
    // 45°, n = 1.5 (Hecht, Optics, gives 9.2 % for the s and 0.85 % for the p part).
    EXPECT_NEAR(fresnel_dielectric(std::cos(degrees(45)), 1.5), 0.050240, 1e-6);
    EXPECT_NEAR(fresnel_dielectric(std::cos(degrees(60)), 1.5), 0.089187, 1e-6);
}

TEST(Fresnel, SineAndTangentLaws) {
    for (double angle = 3; angle < 90; angle += 3) {
        const double i = degrees(angle), t = std::asin(std::sin(i) / 1.7);
        const double s = std::sin(i - t) / std::sin(i + t), p = std::tan(i - t) / std::tan(i + t);
        EXPECT_NEAR(fresnel_dielectric(std::cos(i), 1.7), (s * s + p * p) / 2, 1e-12) << angle;
        // From inside at the refracted angle it is the same: reciprocity.
        EXPECT_NEAR(fresnel_dielectric(std::cos(t), 1 / 1.7), (s * s + p * p) / 2, 1e-12) << angle;
    }
}

TEST(Fresnel, TotalInternalReflection) {
    const double critical = std::asin(1 / 1.5);
    EXPECT_EQ(fresnel_dielectric(std::cos(critical + 1e-9), 1 / 1.5), 1);
    EXPECT_LT(fresnel_dielectric(std::cos(critical - 1e-3), 1 / 1.5), 1);
    EXPECT_FALSE(refract_ray({std::sin(critical + 1e-9), -std::cos(critical + 1e-9), 0}, {0, 1, 0}, 1 / 1.5));
    EXPECT_TRUE(refract_ray({std::sin(critical - 1e-9), -std::cos(critical - 1e-9), 0}, {0, 1, 0}, 1 / 1.5));
}

TEST(Refraction, SnellsLaw) {
    for (double angle = 0; angle < 90; angle += 5) {
        const double i = degrees(angle);
        const auto direction = refract_ray({std::sin(i), -std::cos(i), 0}, {0, 1, 0}, 1.4);
        ASSERT_TRUE(direction);
        EXPECT_NEAR(direction->x, std::sin(i) / 1.4, 1e-15);
        EXPECT_NEAR(glm::length(*direction), 1, 1e-15);
        EXPECT_EQ(direction->z, 0);
        EXPECT_LT(direction->y, 0);
    }
}

/// Integrates over the upper hemisphere.
template <typename Value>
double hemisphere(Value value) {
    const int n = 400;
    double sum = 0;
    for (int i = 0; i < n; i++)
        for (int k = 0; k < n; k++) {
            const double z = (i + 0.5) / n, phi = 2 * pi * (k + 0.5) / n, r = std::sqrt(1 - z * z);
            sum += value(glm::dvec3(r * std::cos(phi), r * std::sin(phi), z)) * 2 * pi / (n * n);
        }
    return sum;
}

TEST(Ggx, ProjectedAreaOfTheFacetsIsOne) {
    for (double alpha : {0.2, 0.5, 1.0})
        EXPECT_NEAR(hemisphere([&](const glm::dvec3& h) { return ggx_distribution(h.z, alpha) * h.z; }), 1, 2e-3);
}

TEST(Ggx, SamplesFollowTheVisibleNormals) {
    // The mean of the samples' z is an integral over D_v = D·G1·max(0, v·h)/v.z.
    for (double alpha : {0.2, 0.6}) {
        const glm::dvec3 view = glm::normalize(glm::dvec3(0.7, -0.2, 0.5));
        const double expected = hemisphere([&](const glm::dvec3& h) {
            return ggx_distribution(h.z, alpha) * ggx_masking(view.z, alpha) * std::max(0.0, glm::dot(view, h)) /
                   view.z * h.z;
        });
        double sum = 0;
        const int n = 20000;
        for (int i = 0; i < n; i++) sum += sample_ggx(view, glm::dvec2(alpha), random_pair(7, uint32_t(i), Purpose::microfacet)).z;
        EXPECT_NEAR(sum / n, expected, 2e-3) << alpha;
    }
}

}  // namespace
}  // namespace peelray::optics
