// The reference's optics against figures that stand in textbooks or follow from them by hand.
#include "reference/optics.h"
#include "reference/random_numbers.h"

#include <gtest/gtest.h>

#include <cmath>

#include "reference/film.h"
#include "reference/sheen.h"

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
        for (int i = 0; i < n; i++)
            sum += sample_ggx(view, glm::dvec2(alpha), random_pair(7, 0, RANDOM_MICROFACET, {uint32_t(i), 16, 0})).z;
        EXPECT_NEAR(sum / n, expected, 2e-3) << alpha;
    }
}

TEST(Ggx, StretchedLobesAreLobes) {
    const Lobe lobe({0, 0, 1}, glm::normalize(glm::dvec3(3, 1, 0)), {0.6, 0.2});
    EXPECT_NEAR(hemisphere([&](const glm::dvec3& h) { return lobe.distribution(h) * h.z; }), 1, 2e-3);
    const glm::dvec3 view = glm::normalize(glm::dvec3(0.7, -0.2, 0.5));
    glm::dvec3 expected(0), sum(0);
    for (int k = 0; k < 3; k++)
        expected[k] = hemisphere([&](const glm::dvec3& h) {
            return lobe.distribution(h) * lobe.masking(view) * std::max(0.0, glm::dot(view, h)) / view.z * h[k];
        });
    const int n = 20000;
    for (int i = 0; i < n; i++) sum += lobe.sample(view, random_pair(7, 0, RANDOM_MICROFACET, {uint32_t(i), 16, 0}));
    EXPECT_LT(glm::length(sum / double(n) - expected), 3e-3);
    EXPECT_EQ(lobe.masking({0.6, 0, -0.8}), 0);
}

TEST(Ggx, RoundLobesAreTheOnesOfOneWidth) {
    const glm::dvec3 n = glm::normalize(glm::dvec3(1, 2, -1)), d = glm::normalize(glm::dvec3(1, 1, 0.5));
    const Lobe lobe(n, 0.3);
    EXPECT_NEAR(lobe.masking(d), ggx_masking(glm::dot(n, d), 0.3), 1e-14);
    EXPECT_NEAR(lobe.distribution(d), ggx_distribution(glm::dot(n, d), 0.3), 1e-12);
}

TEST(Film, WithoutThicknessOnlyTheBaseReflects) {
    for (double cosine : {1.0, 0.6, 0.1}) {
        const glm::dvec3 got = film::reflectance(cosine, 1.7, 0, {1.3, 1.5, 2});
        EXPECT_NEAR(got.x, fresnel_dielectric(cosine, 1.3), 1e-12);
        EXPECT_NEAR(got.y, fresnel_dielectric(cosine, 1.5), 1e-12);
        EXPECT_NEAR(got.z, fresnel_dielectric(cosine, 2), 1e-12);
    }
}

TEST(Film, OfTheBasesIndexItIsTheBase) {
    EXPECT_NEAR(film::reflectance(0.5, 1.5, 300, glm::dvec3(1.5)).y, fresnel_dielectric(0.5, 1.5), 1e-12);
}

TEST(Film, IndexReflectsWhatItIsMadeFor) {
    const glm::dvec3 f0(0, 0.04, 0.9), n = film::index_of(f0);
    for (int k = 0; k < 3; k++) EXPECT_NEAR(fresnel_dielectric(1, n[k]), f0[k], 1e-12);
    EXPECT_NEAR(fresnel_dielectric(1, film::index_of(glm::dvec3(1)).x), 0.9999, 1e-9);
}

TEST(Sheen, AlbedoIsTheLobesIntegral) {
    // The mean of the lobe over directions of equal solid angle.
    for (const double alpha : {0.0049, 0.04, 0.25, 1.0})
        for (const double cosine : {0.9, 0.4, 0.15}) {
            const glm::dvec3 view(std::sqrt(1 - cosine * cosine), 0, cosine);
            const double integral = hemisphere(
                [&](const glm::dvec3& l) { return sheen::lobe(alpha, glm::normalize(view + l).z, cosine, l.z); });
            EXPECT_NEAR(sheen::albedo(alpha, cosine), integral, 2e-3) << alpha << ", " << cosine;
        }
}

}  // namespace
}  // namespace peelray::optics
