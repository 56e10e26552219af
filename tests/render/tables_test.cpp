// The tabulated split sum and the fit of Fresnel's formula against quadrature that shares nothing with them.
#include "path_tables.h"

#include <scenes.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "path/tables.h"
#include "render/fresnel_fit.h"

namespace peelray {
namespace {

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
    for (int row = 5; row < SPLIT_SUM_SIDE; row += 4)
        for (int column = 0; column < SPLIT_SUM_SIDE; column += 5)
            for (size_t k = 0; k < 4; k++) {
                const double want = ggx_mean(cosine_of(column), roughness_of(row),
                                             [&](double c) { return std::pow(1 - c, kExponents[k]); });
                EXPECT_NEAR(kTables[TABLE_SPLIT_SUM + row * SPLIT_SUM_SIDE + column][k], want, 2e-3)
                    << "roughness " << roughness_of(row) << ", cosine " << cosine_of(column) << ", power " << k;
            }
}

TEST(SplitSum, WithoutRoughnessTheSurfaceIsItsOnlyMicrofacet) {
    for (int column = 0; column < SPLIT_SUM_SIDE; column++)
        for (size_t k = 0; k < 4; k++)
            EXPECT_NEAR(kTables[TABLE_SPLIT_SUM + column][k], std::pow(1 - cosine_of(column), kExponents[k]), 1e-6);
}

TEST(SplitSum, NothingReflectsMoreThanItGets) {
    for (const auto& entry : std::span(kTables).first<SPLIT_SUM_SIDE * SPLIT_SUM_SIDE>()) {
        EXPECT_LE(entry[0], 1.0f);
        EXPECT_TRUE(entry[0] >= entry[1] && entry[1] >= entry[2] && entry[2] >= entry[3] && entry[3] >= 0);
    }
}

TEST(SplitSum, FittedReflectanceHasTheMeansOfTheExactOne) {
    for (double ior : {1.0001, 1.01, 1.1, 1.33, 1.5, 1.8, 2.4, 4.0}) {
        const glm::vec4 fit = fresnel_fit(ior);
        for (double roughness : {0.1, 0.3, 0.6, 1.0})
            for (double cosine : {0.05, 0.2, 0.5, 0.9}) {
                double got = 0;
                for (int k = 0; k < 4; k++)
                    got +=
                        fit[k] * ggx_mean(cosine, roughness, [&](double c) { return std::pow(1 - c, kExponents[k]); });
                EXPECT_NEAR(got, ggx_mean(cosine, roughness, [&](double c) { return fresnel(c, 1, ior); }),
                            ior < 1.1 ? 0.045  // no four powers follow a reflection that rises from nothing at the rim
                            : ior > 2.4 ? 5e-3
                                        : 1e-3)
                    << "index " << ior << ", roughness " << roughness << ", cosine " << cosine;
            }
    }
}

}  // namespace
}  // namespace peelray
