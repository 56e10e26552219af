#include "scene/light_distribution.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/parallel.h"
#include "scene/environment.h"
#include "scene/pi.h"
#include "scene/probabilities.h"
#include "scene/sampling.h"

namespace peelray {
namespace {

/// Even x in the even bits, y in the odd ones.
uint32_t morton(uint32_t x, uint32_t y) {
    const auto spread = [](uint32_t v) {
        v = (v | v << 8) & 0x00ff00ffu;
        v = (v | v << 4) & 0x0f0f0f0fu;
        v = (v | v << 2) & 0x33333333u;
        return (v | v << 1) & 0x55555555u;
    };
    return spread(x) | spread(y) << 1;
}

uint32_t depth_for(const Environment& environment) {
    constexpr uint32_t least = 2, most = 10;
    const uint32_t height = std::max({environment.width / 2, environment.height, 1u});
    return std::clamp(uint32_t(std::bit_width(std::bit_ceil(height))) - 1, least, most);
}

/// Mean of the colours of the finest level's texels.
std::vector<double> means_of(const Environment& environment) {
    std::vector<double> means(size_t(environment.width) * environment.height);
    for (size_t i = 0; i < means.size(); i++) means[i] = mean_color(glm::dvec3(environment.texels[i]));
    return means;
}

}  // namespace

EnvironmentDistribution::EnvironmentDistribution(const Environment& environment) : depth(depth_for(environment)) {
    const uint32_t height = 1u << depth, width = 2 * height;
    // Lookups interpolate: a few points of each texel that a cell covers make its mean. Three points a side integrate
    // what is linear on either side of a texel's centre exactly (the trapezoidal rule).
    const uint32_t across = std::max(1u, (environment.width + width - 1) / width),
                   down = std::max(1u, (environment.height + height - 1) / height);
    const int columns = int(environment.width), rows = int(environment.height);
    const std::vector<double> means = means_of(environment);
    const auto mean_at = [&](int x, int y) {
        return means[size_t(std::clamp(y, 0, rows - 1)) * size_t(columns) + size_t((x + columns) % columns)];
    };
    std::vector<double> cells(size_t(width) * height);
    parallel_for(height, 4, [&](size_t y) {
        const double area = std::cos(kPi * double(y) / height) - std::cos(kPi * double(y + 1) / height);
        for (uint32_t x = 0; x < width; x++) {
            double sum = 0;
            for (uint32_t i = 0; i < 9 * across * down; i++) {
                const uint32_t column = i % (3 * across), row = i / (3 * across);
                const double weight = (column % 3 == 1 ? 2.0 : 1.0) * (row % 3 == 1 ? 2.0 : 1.0);
                const double px = x + (column / 3 + 0.5 * (column % 3)) / across,
                             py = double(y) + (row / 3 + 0.5 * (row % 3)) / down;
                sum += weight * bilinear(glm::dvec2(px * columns / width, py * rows / height), mean_at);
            }
            const uint32_t half = x / height;
            cells[(size_t(half) << 2 * depth) + morton(x % height, uint32_t(y))] = sum * area;
        }
    });
    double total = 0;
    for (const double cell : cells) total += cell;
    if (!(total > 0))
        for (uint32_t i = 0; i < cells.size(); i++) cells[i] = 1;  // no light: any direction is as good
    quads.resize(first(depth + 1));
    for (uint32_t level = depth; level >= 1; level--) {
        const uint32_t begin = first(level);
        std::vector<double> above(cells.size() / 4);
        for (size_t q = 0; q < above.size(); q++) {
            const double* const c = &cells[4 * q];
            quads[begin + q] = glm::vec4(glm::dvec4(c[0], c[1], c[2], c[3]));
            above[q] = c[0] + c[1] + c[2] + c[3];
        }
        cells = std::move(above);
    }
    total = cells[0] + cells[1];
    quads[0] = glm::vec4(float(cells[0]), float(cells[1]), 0, 0);
    for (glm::vec4& quad : quads) quad = glm::vec4(glm::dvec4(quad) / total);
}

}  // namespace peelray
