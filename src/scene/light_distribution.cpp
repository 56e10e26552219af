#include "scene/light_distribution.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "base/parallel.h"
#include "scene/environment.h"
#include "scene/pi.h"
#include "scene/probabilities.h"

namespace peelray {
namespace {

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

/// What the texels along one side of the map count for one cell, from the first on.
struct Taps {
    int first;
    std::vector<double> weights;
};

/// Lookups interpolate: a few points of each texel that a cell covers make its mean. Three points a side integrate what
/// is linear on either side of a texel's centre exactly (the trapezoidal rule).
Taps taps_of(uint32_t cell, uint32_t cells, uint32_t texels) {
    const uint32_t covered = std::max(1u, (texels + cells - 1) / cells);
    const auto place = [&](uint32_t i) { return (cell + (i / 3 + 0.5 * (i % 3)) / covered) * texels / cells - 0.5; };
    Taps taps{int(std::floor(place(0))), {}};
    for (uint32_t i = 0; i < 3 * covered; i++) {
        const double at = place(i), low = std::floor(at), weight = i % 3 == 1 ? 2 : 1;
        const size_t before = size_t(int(low) - taps.first);
        taps.weights.resize(std::max(taps.weights.size(), before + 2), 0);
        taps.weights[before] += weight * (1 - (at - low));
        taps.weights[before + 1] += weight * (at - low);
    }
    return taps;
}

}  // namespace

EnvironmentDistribution::EnvironmentDistribution(const Environment& environment) : depth(depth_for(environment)) {
    const uint32_t height = 1u << depth, width = 2 * height;
    const int columns = int(environment.width), rows = int(environment.height);
    const std::vector<double> means = means_of(environment);
    std::vector<Taps> across;
    for (uint32_t x = 0; x < width; x++) across.push_back(taps_of(x, width, environment.width));
    std::vector<double> cells(size_t(width) * height);
    parallel_for(height, 4, [&](size_t y) {
        const double area = std::cos(kPi * double(y) / height) - std::cos(kPi * double(y + 1) / height);
        // Down the columns first, one more on either side than there are: the map goes round.
        const Taps down = taps_of(uint32_t(y), height, environment.height);
        std::vector<double> sums(size_t(columns) + 2, 0);
        for (size_t j = 0; j < down.weights.size(); j++) {
            const double* const row = &means[size_t(std::clamp(down.first + int(j), 0, rows - 1)) * size_t(columns)];
            for (size_t x = 0; x < size_t(columns); x++) sums[x + 1] += down.weights[j] * row[x];
        }
        sums.front() = sums[size_t(columns)];
        sums.back() = sums[1];
        for (uint32_t x = 0; x < width; x++) {
            const double* const first = &sums[size_t(across[x].first + 1)];
            const double sum = std::inner_product(across[x].weights.begin(), across[x].weights.end(), first, 0.0);
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
