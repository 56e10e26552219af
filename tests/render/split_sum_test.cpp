// The tabulated split sum and the fit of Fresnel's formula against quadrature that shares nothing with them.
#include "split_sum_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>

#include "path/split_sum.h"
#include "render/fresnel_fit.h"

namespace peelray {
namespace {

/// The mean of value(v·h) over what the view of a GGX surface reflects: D·G1(v)·G1(l) / (4 (n·v)) over the directions l
/// of the light. The rings are those of the microfacets of equal shares, so that smooth surfaces are resolved.
double mean_reflected(double cosine, double alpha, const std::function<double(double)>& value) {
    const auto lambda = [&](double c) { return (std::sqrt(1 + alpha * alpha * (1 / (c * c) - 1)) - 1) / 2; };
    const double sine = std::sqrt(1 - cosine * cosine);
    const int rings = 240, sectors = 120;
    double sum = 0;
    for (int i = 0; i < rings; i++) {
        const double u = (i + 0.5) / rings, c = 1 / std::sqrt(1 + alpha * alpha * u / (1 - u));
        for (int k = 0; k < sectors; k++) {
            const double v_h =
                sine * std::sqrt(1 - c * c) * std::cos(std::numbers::pi * (k + 0.5) / sectors) + cosine * c;
            const double n_l = 2 * v_h * c - cosine;
            if (v_h > 0 && n_l > 0)
                sum += value(std::min(v_h, 1.0)) * v_h / (c * cosine * (1 + lambda(cosine)) * (1 + lambda(n_l)));
        }
    }
    return sum / (rings * sectors);
}

const std::array<int, 4> kExponents = {0, SPLIT_SUM_FLAT_EXPONENT, SPLIT_SUM_SCHLICK_EXPONENT,
                                       SPLIT_SUM_STEEP_EXPONENT};

/// Of entry (row, column).
double roughness_of(int row) {
    return std::pow(row / (SPLIT_SUM_SIDE - 1.0), 2);
}
double cosine_of(int column) {
    return std::max(1e-4, std::pow(column / (SPLIT_SUM_SIDE - 1.0), 2));
}

TEST(SplitSum, EntriesAreMeansOverMicrofacets) {
    for (int row = 5; row < SPLIT_SUM_SIDE; row += 2)
        for (int column = 0; column < SPLIT_SUM_SIDE; column += 3)
            for (size_t k = 0; k < 4; k++) {
                const double want = mean_reflected(cosine_of(column), std::pow(roughness_of(row), 2),
                                                   [&](double c) { return std::pow(1 - c, kExponents[k]); });
                EXPECT_NEAR(kSplitSum[row * SPLIT_SUM_SIDE + column][k], want,
                            cosine_of(column) < 0.1 ? 0.03 : 5e-3)  // both quadratures have an edge at the horizon
                    << "roughness " << roughness_of(row) << ", cosine " << cosine_of(column) << ", power " << k;
            }
}

TEST(SplitSum, WithoutRoughnessTheSurfaceIsItsOnlyMicrofacet) {
    for (int column = 0; column < SPLIT_SUM_SIDE; column++)
        for (size_t k = 0; k < 4; k++)
            EXPECT_NEAR(kSplitSum[column][k], std::pow(1 - cosine_of(column), kExponents[k]), 1e-6);
}

TEST(SplitSum, NothingReflectsMoreThanItGets) {
    for (const auto& entry : kSplitSum) {
        EXPECT_LE(entry[0], 1.0f);
        EXPECT_TRUE(entry[0] >= entry[1] && entry[1] >= entry[2] && entry[2] >= entry[3] && entry[3] >= 0);
    }
}

double exact_reflectance(double cosine, double ior) {
    const double angle = std::acos(cosine), behind = std::asin(std::sin(angle) / ior);
    if (angle < 1e-6) return std::pow((ior - 1) / (ior + 1), 2);
    return (std::pow(std::sin(angle - behind) / std::sin(angle + behind), 2) +
            std::pow(std::tan(angle - behind) / std::tan(angle + behind), 2)) /
           2;
}

TEST(SplitSum, FittedReflectanceHasTheMeansOfTheExactOne) {
    for (double ior : {1.0001, 1.1, 1.33, 1.5, 1.8, 2.4, 4.0}) {
        const glm::vec3 fit = fresnel_fit(ior);
        for (double roughness : {0.1, 0.3, 0.6, 1.0})
            for (double cosine : {0.05, 0.2, 0.5, 0.9}) {
                const double alpha = roughness * roughness;
                double got =
                    std::pow((ior - 1) / (ior + 1), 2) * mean_reflected(cosine, alpha, [](double) { return 1; });
                for (int k = 0; k < 3; k++)
                    got += fit[k] *
                           mean_reflected(cosine, alpha, [&](double c) { return std::pow(1 - c, kExponents[k + 1]); });
                EXPECT_NEAR(got, mean_reflected(cosine, alpha, [&](double c) { return exact_reflectance(c, ior); }),
                            ior < 1.01 ? 0.02 : 5e-3)  // three powers cannot follow the rise of a faint reflection
                    << "index " << ior << ", roughness " << roughness << ", cosine " << cosine;
            }
    }
}

}  // namespace
}  // namespace peelray
