#include "statistics/sphere_cells.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace peelray::test {

SphereCells::SphereCells(const glm::dvec3& axis, double width, bool half, int rings, int sectors)
    : axis_(axis), width2_(width * width), most_(half ? 1 / (1 + width * width) : 1), rings_(rings), sectors_(sectors) {
    x_ = glm::normalize(glm::cross(std::abs(axis.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0), axis));
    y_ = glm::cross(axis, x_);
}

size_t SphereCells::cell(const glm::dvec3& direction) const {
    const double x = glm::dot(direction, x_), y = glm::dot(direction, y_), across2 = x * x + y * y;
    // tan(angle / 2) = sine / (1 + cosine) keeps its digits close to the axis.
    const double below = glm::length(direction) + glm::dot(direction, axis_), t = across2 / (below * below);
    const double u = below > 0 ? t / (t + width2_) : 1, turn = std::atan2(y, x) / (2 * pi);
    const int ring = std::clamp(int(u / most_ * rings_), 0, rings_ - 1);
    const int sector = std::clamp(int((turn < 0 ? turn + 1 : turn) * sectors_), 0, sectors_ - 1);
    return size_t(ring * sectors_ + sector);
}

/// By Gauss's rule of 3 by 3 points; positions are (u, phi).
double SphereCells::gauss(const Density& density, const glm::dvec2& low, const glm::dvec2& high) const {
    constexpr std::array<double, 3> places{-0.7745966692414834, 0, 0.7745966692414834},
        weights{5 / 18., 8 / 18., 5 / 18.};
    const glm::dvec2 middle = 0.5 * (low + high), half = 0.5 * (high - low);
    std::array<glm::dvec3, 3> across;
    for (size_t k = 0; k < 3; k++) {
        const double phi = middle.y + half.y * places[k];
        across[k] = std::cos(phi) * x_ + std::sin(phi) * y_;
    }
    double sum = 0;
    for (size_t i = 0; i < 3; i++) {
        const double u = middle.x + half.x * places[i], t = width2_ * u / (1 - u);
        const double sine = 2 * std::sqrt(t) / (1 + t);
        const glm::dvec3 along = (1 - t) / (1 + t) * axis_;
        // The cosine (1 - t) / (1 + t) changes with u by 2 / (1 + t)² · dt/du.
        const double slope = 2 * width2_ / ((1 + t) * (1 + t) * (1 - u) * (1 - u));
        for (size_t k = 0; k < 3; k++) sum += weights[i] * weights[k] * slope * density(sine * across[k] + along);
    }
    return sum * 4 * half.x * half.y;
}

double SphereCells::refined(const Density& density, const glm::dvec2& low, const glm::dvec2& high, double coarse,
                            int depth) const {
    const glm::dvec2 middle = 0.5 * (low + high);
    const std::array<glm::dvec2, 4> lows{low, {middle.x, low.y}, {low.x, middle.y}, middle};
    std::array<double, 4> parts{};
    double sum = 0;
    for (size_t i = 0; i < 4; i++) sum += parts[i] = gauss(density, lows[i], lows[i] + middle - low);
    // The first three steps are taken anyway, to miss nothing that lies between the points.
    if (depth > 1 && (std::abs(sum - coarse) < 1e-7 || depth == 10)) return sum;
    sum = 0;
    for (size_t i = 0; i < 4; i++) sum += refined(density, lows[i], lows[i] + middle - low, parts[i], depth + 1);
    return sum;
}

std::vector<double> SphereCells::integrate(const Density& density) const {
    std::vector<double> sums;
    for (int ring = 0; ring < rings_; ring++)
        for (int sector = 0; sector < sectors_; sector++) {
            const glm::dvec2 low(most_ * ring / rings_, 2 * pi * sector / sectors_);
            const glm::dvec2 high(most_ * (ring + 1) / rings_, 2 * pi * (sector + 1) / sectors_);
            sums.push_back(refined(density, low, high, 0, 0));
        }
    return sums;
}

}  // namespace peelray::test
