// Pearson's chi-square test: do counts follow what a distribution lets expect?
#pragma once

#include <cstdint>
#include <ostream>
#include <span>

namespace peelray::test {

/// Q(a, x) = Γ(a, x) / Γ(a), the upper regularised incomplete gamma function; a > 0, x ≥ 0. Its series below a + 1, its
/// continued fraction above (Press et al., Numerical Recipes, section 6.2).
double upper_gamma(double a, double x);

struct ChiSquare {
    double statistic;  ///< sum of (observed - expected)² / expected
    int freedom;       ///< cells less one: they share a total
    double p;          ///< chance of a statistic at least this large if the counts follow the distribution
};
std::ostream& operator<<(std::ostream& out, const ChiSquare& fit);

/// Of cells with as many counts as `observed` says. Those that expect least are taken together until all expect at
/// least `least`, for only then the statistic has its known distribution. The totals must be the same, but for
/// rounding.
ChiSquare chi_square(std::span<const uint32_t> observed, std::span<const double> expected, double least = 5);

/// The least p that each of `tests` tests may have so that, if all is right, all pass with a chance of 1 - `level`
/// (Šidák 1967).
double sidak(double level, int tests);

}  // namespace peelray::test
