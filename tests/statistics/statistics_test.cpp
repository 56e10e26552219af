// The chi-square tests themselves: closed forms, tables, dice that are fair and dice that are not.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numeric>
#include <random>

#include "statistics/lobes.h"
#include "statistics/sphere_cells.h"

namespace peelray::test {
namespace {

TEST(UpperGamma, ClosedForms) {
    for (const double x : {1e-6, 0.1, 0.5, 1.0, 1.9, 2.1, 3.0, 10.0, 40.0, 300.0}) {
        EXPECT_NEAR(upper_gamma(1, x) / std::exp(-x), 1, 1e-12) << x;
        EXPECT_NEAR(upper_gamma(0.5, x), std::erfc(std::sqrt(x)), 1e-14) << x;
        // Of a whole number it is the chance of fewer than that many Poisson events.
        for (const int a : {2, 5, 30, 200}) {
            double term = std::exp(-x), sum = term;
            for (int k = 1; k < a; k++) sum += term *= x / k;
            EXPECT_NEAR(upper_gamma(a, x), sum, 2e-12) << a << " " << x;
        }
        // Q(a + 1, x) = Q(a, x) + x^a exp(-x) / Γ(a + 1)
        for (const double a : {0.3, 7.7, 319.5})
            EXPECT_NEAR(upper_gamma(a + 1, x), upper_gamma(a, x) + std::exp(a * std::log(x) - x - std::lgamma(a + 1)),
                        1e-12);
    }
    EXPECT_EQ(upper_gamma(3, 0), 1);
}

TEST(UpperGamma, QuantilesOfTables) {
    struct Row {
        int freedom;
        double p, quantile;
    };
    // NIST/SEMATECH e-Handbook of Statistical Methods, section 1.3.6.7.4.
    for (const Row& row : {Row{1, 0.05, 3.841},
                           {1, 0.01, 6.635},
                           {2, 0.05, 5.991},
                           {10, 0.05, 18.307},
                           {10, 0.95, 3.940},
                           {30, 0.01, 50.892},
                           {50, 0.99, 29.707},
                           {100, 0.001, 149.449},
                           {100, 0.05, 124.342}})
        EXPECT_NEAR(upper_gamma(0.5 * row.freedom, 0.5 * row.quantile) / row.p, 1, 1e-3) << row.freedom;
}

TEST(ChiSquare, ByHand) {
    // (8 - 10)²/10 + (12 - 10)²/10 + (25 - 20)²/20 + (15 - 20)²/20
    const ChiSquare fit = chi_square(std::array<uint32_t, 4>{8, 12, 25, 15}, std::array<double, 4>{10, 10, 20, 20});
    EXPECT_NEAR(fit.statistic, 3.3, 1e-12);
    EXPECT_EQ(fit.freedom, 3);
    EXPECT_NEAR(fit.p, 0.3476, 1e-4);
}

TEST(ChiSquare, SmallCellsAreTakenTogether) {
    // 3 and 1 and 2 make a cell of 6.
    const ChiSquare fit = chi_square(std::array<uint32_t, 4>{1, 2, 44, 3}, std::array<double, 4>{3, 1, 44, 2});
    EXPECT_EQ(fit.freedom, 1);
    EXPECT_EQ(fit.statistic, 0);
    // What is left over goes to the last.
    EXPECT_EQ(chi_square(std::array<uint32_t, 3>{4, 4, 4}, std::array<double, 3>{4, 4, 4}).freedom, 0);
    // Where nothing may be.
    EXPECT_EQ(chi_square(std::array<uint32_t, 2>{30, 70}, std::array<double, 2>{0, 100}).p, 1) << "one cell of 100";
    EXPECT_LT(chi_square(std::array<uint32_t, 3>{30, 35, 35}, std::array<double, 3>{0, 50, 50}).p, 0.02);
    EXPECT_EQ(chi_square(std::array<uint32_t, 2>{30, 0}, std::array<double, 2>{0, 0}).p, 0);
}

TEST(ChiSquare, SidakLeavesTheWholeAtItsLevel) {
    EXPECT_NEAR(sidak(0.05, 10), 0.0051162, 1e-7);
    EXPECT_NEAR(1 - std::pow(1 - sidak(0.01, 120), 120), 0.01, 1e-12);
    EXPECT_EQ(sidak(0.01, 1), 0.01);
}

/// Throws of a die that shows a six `six` times as often as it should.
ChiSquare die(double six, int throws, uint32_t seed) {
    std::array<uint32_t, 6> faces{};
    std::mt19937 random(seed);
    for (int i = 0; i < throws; i++) {
        const double x = double(random()) / 4294967296.0, others = 1 - six / 6;
        faces[x >= others ? 5 : size_t(x / others * 5)]++;
    }
    return chi_square(faces, std::vector<double>(6, throws / 6.0));
}

TEST(ChiSquare, FairDicePassAndBiasedOnesFail) {
    EXPECT_GT(die(1, 60000, 1).p, 0.01);
    for (uint32_t seed = 1; seed <= 20; seed++) EXPECT_LT(die(1.1, 60000, seed).p, 1e-6) << seed;
}

TEST(ChiSquare, FairDicesChancesAreUniform) {
    std::array<uint32_t, 10> tenths{};
    for (uint32_t seed = 1; seed <= 400; seed++) tenths[std::min<size_t>(9, size_t(die(1, 3000, seed).p * 10))]++;
    EXPECT_GT(chi_square(tenths, std::vector<double>(10, 40)).p, 0.01);
}

TEST(SphereCells, CellsOfWidthOneAreEqual) {
    const SphereCells cells(glm::dvec3(0.48, 0.6, 0.64), 1);
    for (const double area : cells.integrate([](const glm::dvec3&) { return 1; }))
        ASSERT_NEAR(area, 4 * pi / double(cells.count()), 1e-9);
}

TEST(SphereCells, DirectionsLieWhereTheirDensityIs) {
    // Uniform directions and their known density, in cells of any width; the same ones against a density of 1 + d.z
    // / 10.
    for (const double width : {0.05, 0.2, 1.0}) {
        const SphereCells cells(glm::dvec3(0.48, 0.6, 0.64), width);
        auto even = cells.integrate([](const glm::dvec3&) { return 1 / (4 * pi); });
        auto other = cells.integrate([](const glm::dvec3& d) { return (1 + d.z / 10) / (4 * pi); });
        for (const auto* sums : {&even, &other}) EXPECT_NEAR(std::accumulate(sums->begin(), sums->end(), 0.0), 1, 1e-5);
        std::vector<uint32_t> counts(cells.count());
        const auto pairs = independent_pairs(100000, 5);
        for (const glm::vec2& p : pairs) {
            const double z = 2 * double(p.x) - 1, r = std::sqrt(1 - z * z), phi = 2 * pi * p.y;
            counts[cells.cell({r * std::cos(phi), r * std::sin(phi), z})]++;
        }
        for (double& e : even) e *= 100000;
        for (double& e : other) e *= 100000;
        EXPECT_GT(chi_square(counts, even).p, 0.01) << width;
        EXPECT_LT(chi_square(counts, other).p, 1e-3) << width;
    }
}

TEST(SphereCells, EdgesOfADensityAreFound) {
    // A cap off the axis: its share of the sphere is (1 - cosine) / 2.
    const glm::dvec3 middle(0.6, 0, 0.8);
    const SphereCells cells(glm::dvec3(0, 0, 1), 0.3);
    const auto sums =
        cells.integrate([&](const glm::dvec3& d) { return glm::dot(d, middle) > 0.7 ? 1 / (4 * pi) : 0; });
    EXPECT_NEAR(std::accumulate(sums.begin(), sums.end(), 0.0), 0.15, 5e-5);
}

TEST(Uniform, PairsPassAndTheirSquaresFail) {
    auto pairs = independent_pairs(100000, 9);
    EXPECT_GT(fit_uniform(pairs).p, 0.01);
    for (glm::vec2& p : pairs) p.x = std::pow(p.x, 1.05f);
    EXPECT_LT(fit_uniform(pairs).p, 1e-6);
}

}  // namespace
}  // namespace peelray::test
