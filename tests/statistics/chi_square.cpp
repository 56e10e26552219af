#include "statistics/chi_square.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

namespace peelray::test {
namespace {

constexpr double epsilon = 1e-16;

/// 1 - Q.
double by_series(double a, double x) {
    double term = 1 / a, sum = term;
    for (double n = a + 1; term > epsilon * sum; n++) sum += term *= x / n;
    return sum;
}

/// Q by Lentz's method.
double by_fraction(double a, double x) {
    double b = x + 1 - a, c = std::numeric_limits<double>::infinity(), d = 1 / b, product = d;
    for (int i = 1; i < 100000; i++) {
        const double numerator = -i * (i - a);
        b += 2;
        d = 1 / (b + numerator * d);
        c = b + numerator / c;
        product *= c * d;
        if (std::abs(c * d - 1) < 4 * epsilon) break;
    }
    return product;
}

}  // namespace

double upper_gamma(double a, double x) {
    if (x <= 0) return 1;
    const double scale = std::exp(a * std::log(x) - x - std::lgamma(a));
    return x < a + 1 ? 1 - scale * by_series(a, x) : scale * by_fraction(a, x);
}

std::ostream& operator<<(std::ostream& out, const ChiSquare& fit) {
    return out << "chi-square " << fit.statistic << " of " << fit.freedom << " degrees of freedom, p " << fit.p;
}

ChiSquare chi_square(std::span<const uint32_t> observed, std::span<const double> expected, double least) {
    std::vector<size_t> order(expected.size());
    std::iota(order.begin(), order.end(), size_t(0));
    std::sort(order.begin(), order.end(), [&](size_t a, size_t b) { return expected[a] < expected[b]; });
    struct Group {
        double expected = 0, observed = 0;
    };
    std::vector<Group> groups;
    for (const size_t cell : order) {
        if (groups.empty() || groups.back().expected >= least) groups.emplace_back();
        groups.back().expected += expected[cell];
        groups.back().observed += observed[cell];
    }
    if (groups.size() > 1 && groups.back().expected < least) {
        const Group rest = groups.back();
        groups.pop_back();
        groups.back().expected += rest.expected;
        groups.back().observed += rest.observed;
    }
    ChiSquare fit{0, int(groups.size()) - 1, 1};
    for (const Group& g : groups)
        if (g.observed != g.expected)
            fit.statistic += (g.observed - g.expected) * (g.observed - g.expected) / g.expected;
    if (fit.freedom > 0)
        fit.p = upper_gamma(0.5 * fit.freedom, 0.5 * fit.statistic);
    else if (!(fit.statistic < 1))  // one group alone: its total is not what was expected
        fit.p = 0;
    return fit;
}

double sidak(double level, int tests) {
    return -std::expm1(std::log1p(-level) / tests);
}

}  // namespace peelray::test
