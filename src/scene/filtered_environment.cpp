#include "scene/filtered_environment.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "base/parallel.h"
#include "path/filtered_numbers.h"
#include "path/shading_numbers.h"
#include "scene/environment.h"
#include "scene/pi.h"
#include "scene/probabilities.h"
#include "scene/sampling.h"

namespace peelray {
namespace {

/// An equirectangular picture, rows from the top.
struct Map {
    uint32_t width = 0, height = 0;
    std::vector<glm::vec3> texels;

    glm::vec3 direction(size_t i) const {
        return environment_direction((float(i % width) + 0.5f) / float(width),
                                     (float(i / width) + 0.5f) / float(height));
    }
    /// Of any texel of a row.
    double solid_angle(size_t row) const {
        const double top = kPi * double(row) / height, bottom = kPi * double(row + 1) / height;
        return 2 * kPi / width * (std::cos(top) - std::cos(bottom));
    }
    glm::dvec3 at(const glm::dvec3& d) const {
        const glm::dvec2 place(0.5 + std::atan2(d.x, -d.z) / (2 * kPi), std::acos(std::clamp(d.y, -1.0, 1.0)) / kPi);
        return bilinear_around(place, width, height, [&](size_t i) { return glm::dvec3(texels[i]); });
    }
};

/// The environment without the spot that a light stands for, which becomes as bright as the rest on the mean
/// (image_environment() counts it so in the irradiance).
Map without_spot(const Environment& environment) {
    Map map{environment.width, environment.height, {}};
    map.texels.assign(environment.texels.begin(), environment.texels.begin() + ptrdiff_t(map.width) * map.height);
    if (!environment.is_image || environment.lights.empty()) return map;
    const glm::vec3 to_spot = -environment.lights[0].direction;
    constexpr float spot_cosine = 0.98f;  // of all that may be part of it
    std::vector<size_t> spot;
    double rest = 0, area = 0;
    for (size_t i = 0; i < map.texels.size(); i++) {
        const glm::vec3& texel = map.texels[i];
        const float bright = glm::dot(texel, glm::vec3(LUMINANCE_RED, LUMINANCE_GREEN, LUMINANCE_BLUE));
        if (bright >= environment.rough_limit && glm::dot(map.direction(i), to_spot) >= spot_cosine) {
            spot.push_back(i);
            continue;
        }
        rest += bright * map.solid_angle(i / map.width);
        area += map.solid_angle(i / map.width);
    }
    for (const size_t i : spot) map.texels[i] = glm::vec3(float(rest / area));
    return map;
}

/// Means of four texels.
Map halved(const Map& map) {
    Map half{std::max(map.width / 2, 1u), std::max(map.height / 2, 1u), {}};
    half.texels.resize(size_t(half.width) * half.height);
    for (size_t i = 0; i < half.texels.size(); i++) {
        const uint32_t x = uint32_t(i % half.width) * 2, y = uint32_t(i / half.width) * 2;
        const uint32_t x1 = std::min(x + 1, map.width - 1), y1 = std::min(y + 1, map.height - 1);
        const auto row = [&](uint32_t at) { return &map.texels[size_t(at) * map.width]; };
        half.texels[i] = 0.25f * (row(y)[x] + row(y)[x1] + row(y1)[x] + row(y1)[x1]);
    }
    return half;
}

/// With about as many rows as `rows`, from the first level that has no more, of which smaller ones are magnified: a few
/// large texels are no places for many directions.
Map coarse_map(const std::vector<Map>& pyramid, uint32_t rows) {
    const Map& found = *std::ranges::find_if(pyramid, [&](const Map& map) { return map.height <= rows; });
    if (2 * found.height > rows) return found;
    Map map{2 * rows, rows, std::vector<glm::vec3>(2 * size_t(rows) * rows)};
    for (size_t i = 0; i < map.texels.size(); i++) map.texels[i] = glm::vec3(found.at(glm::dvec3(map.direction(i))));
    return map;
}

/// Down to one row.
std::vector<Map> pyramid_of(Map map) {
    std::vector<Map> pyramid;
    pyramid.push_back(std::move(map));
    while (pyramid.back().height > 1) pyramid.push_back(halved(pyramid.back()));
    return pyramid;
}

/// The distribution of GGX, times the normal's cosine to the light; `cosine`: that one.
double ggx_weight(double cosine, double alpha) {
    if (cosine <= 0) return 0;
    const double half2 = 0.5 * (1 + cosine), width = half2 * (alpha * alpha - 1) + 1;
    return cosine / (width * width);
}

/// A direction in the frame whose z is the mirrored one.
struct LobeTap {
    glm::dvec3 direction;
    double weight;
    size_t level;  ///< whose texels are as large as the part of the lobe that the tap stands for
};

std::vector<LobeTap> lobe_taps(double alpha, const std::vector<Map>& pyramid) {
    constexpr uint32_t rings = 8, spokes = 8;
    std::vector<LobeTap> taps;
    for (uint32_t i = 0; i < rings * spokes; i++) {
        const double u = (i / spokes + 0.5) / rings, phi = 2 * kPi * (i % spokes + 0.5 * (i / spokes % 2)) / spokes;
        const double half2 = (1 - u) / (1 + (alpha * alpha - 1) * u), z = 2 * half2 - 1;
        if (z <= 0) continue;
        const double width = half2 * (alpha * alpha - 1) + 1, density = alpha * alpha / (kPi * width * width) / 4;
        const double texels = double(pyramid[0].texels.size()) / (4 * kPi * density * rings * spokes);
        const double level = std::clamp(0.5 * std::log2(texels) + 0.5, 0.0, double(pyramid.size() - 1));
        const double across = std::sqrt(1 - z * z);
        taps.push_back({{across * std::cos(phi), across * std::sin(phi), z}, z, size_t(level)});
    }
    return taps;
}

glm::dvec3 tapped(const glm::dvec3& d, const std::vector<LobeTap>& taps, const std::vector<Map>& pyramid) {
    const glm::dvec3 up = std::abs(d.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
    const glm::dvec3 side = glm::normalize(glm::cross(up, d)), other = glm::cross(d, side);
    glm::dvec3 sum(0);
    double weights = 0;
    for (const LobeTap& tap : taps) {
        const glm::dvec3& t = tap.direction;
        sum += tap.weight * pyramid[tap.level].at(t.x * side + t.y * other + t.z * d);
        weights += tap.weight;
    }
    return sum / weights;
}

/// A texel of a coarse map.
struct Patch {
    glm::dvec3 direction, radiance;
    double solid_angle;
};

std::vector<Patch> patches_of(const Map& map) {
    std::vector<Patch> patches;
    for (size_t i = 0; i < map.texels.size(); i++)
        patches.push_back({map.direction(i), map.texels[i], map.solid_angle(i / map.width)});
    return patches;
}

/// By all of the map: of wide lobes.
glm::dvec3 summed(const glm::dvec3& d, double alpha, const std::vector<Patch>& patches) {
    glm::dvec3 sum(0);
    double weights = 0;
    for (const Patch& patch : patches) {
        const double weight = ggx_weight(glm::dot(d, patch.direction), alpha) * patch.solid_angle;
        sum += weight * patch.radiance;
        weights += weight;
    }
    return sum / weights;
}

/// What a lobe of this alpha reflects, for all directions of a map of this size.
std::vector<glm::vec4> lobe_level(uint32_t width, uint32_t height, double alpha, const std::vector<Map>& pyramid,
                                  const std::vector<Patch>& patches) {
    // Lobes as wide as some patches are the sum over all of them, which knows no poles.
    constexpr double wide = 0.1;
    const std::vector<LobeTap> taps = lobe_taps(alpha, pyramid);
    std::vector<glm::vec4> texels(size_t(width) * height);
    const Map size{width, height, {}};
    parallel_for(texels.size(), 64, [&](size_t i) {
        const glm::dvec3 d = size.direction(i);
        texels[i] = glm::vec4(glm::vec3(alpha > wide ? summed(d, alpha, patches) : tapped(d, taps, pyramid)), 1);
    });
    return texels;
}

/// Where each point of a Hilbert curve lies in a square; `side`: a power of two.
glm::uvec2 hilbert_place(uint32_t at, uint32_t side) {
    glm::uvec2 place(0);
    for (uint32_t size = 1; size < side; size *= 2, at /= 4) {
        const uint32_t right = 1 & (at / 2), up = 1 & (at ^ right);
        if (up == 0) {
            if (right == 1) place = glm::uvec2(size - 1) - place;
            std::swap(place.x, place.y);
        }
        place += size * glm::uvec2(right, up);
    }
    return place;
}

/// The patches of a map in such an order that neighbours are near each other.
std::vector<Patch> in_curve(const std::vector<Patch>& patches, uint32_t width, uint32_t height) {
    const uint32_t side = std::bit_ceil(std::max(width, height));
    std::vector<Patch> ordered;
    for (uint32_t at = 0; at < side * side; at++) {
        const glm::uvec2 place = hilbert_place(at, side);
        if (place.x < width && place.y < height) ordered.push_back(patches[size_t(place.y) * width + place.x]);
    }
    return ordered;
}

/// How much each patch attracts directions: by its light and, for what sees no bright one, as if it were as bright as
/// all are on the mean.
std::vector<double> attractions_of(const std::vector<Patch>& patches) {
    double mean = 0;
    for (const Patch& patch : patches) mean += mean_color(patch.radiance) * patch.solid_angle / (4 * kPi);
    std::vector<double> attractions;
    for (const Patch& patch : patches)
        attractions.push_back((mean > 0 ? mean_color(patch.radiance) + mean : 1) * patch.solid_angle);
    return attractions;
}

size_t nearest(const std::vector<glm::dvec3>& directions, const glm::dvec3& d) {
    size_t best = 0;
    double most = -2;
    for (size_t k = 0; k < directions.size(); k++)
        if (const double cosine = glm::dot(directions[k], d); cosine > most) {
            most = cosine;
            best = k;
        }
    return best;
}

/// Directions at equal steps of attraction; `offset`: of the first one, in steps.
std::vector<glm::dvec3> spread(const std::vector<Patch>& patches, const std::vector<double>& attractions,
                               double offset) {
    const double step = std::accumulate(attractions.begin(), attractions.end(), 0.0) / FILTERED_DIRECTIONS;
    std::vector<glm::dvec3> directions;
    double before = 0;
    for (size_t i = 0; i < patches.size(); i++) {
        before += attractions[i] / step;
        while (directions.size() < FILTERED_DIRECTIONS && before > double(directions.size()) + offset)
            directions.push_back(patches[i].direction);
    }
    directions.resize(FILTERED_DIRECTIONS, patches.back().direction);
    return directions;
}

/// Each direction stands for the light that is nearer to it than to others, and lies in its middle (Lloyd's algorithm:
/// first in the middle of what attracts).
std::vector<FixedDirection> divided(const std::vector<Patch>& patches, const std::vector<double>& attractions,
                                    double offset) {
    constexpr int rounds = 12;
    std::vector<glm::dvec3> directions = spread(patches, attractions, offset);
    std::vector<FixedDirection> parts(directions.size());
    for (int round = 0; round <= rounds; round++) {
        std::vector<glm::dvec3> middles(directions.size(), glm::dvec3(0)), lights = middles;
        for (size_t i = 0; i < patches.size(); i++) {
            const Patch& patch = patches[i];
            const size_t k = nearest(directions, patch.direction);
            const glm::dvec3 light = patch.radiance * patch.solid_angle;
            middles[k] += patch.direction * (round < rounds ? attractions[i] : mean_color(light));
            lights[k] += light;
        }
        for (size_t k = 0; k < directions.size(); k++) {
            if (middles[k] != glm::dvec3(0)) directions[k] = glm::normalize(middles[k]);
            parts[k] = {glm::vec3(directions[k]), glm::vec3(lights[k])};
        }
    }
    return parts;
}

std::vector<FixedDirection> fixed_directions(const std::vector<Patch>& patches) {
    const std::vector<double> attractions = attractions_of(patches);
    std::vector<FixedDirection> sets(size_t(FILTERED_SETS) * FILTERED_DIRECTIONS);
    parallel_for(FILTERED_SETS, 1, [&](size_t set) {
        const double golden = double(set) * 0.6180339887498949 + 0.5;
        const std::vector<FixedDirection> parts = divided(patches, attractions, golden - std::floor(golden));
        std::ranges::copy(parts, sets.begin() + ptrdiff_t(set * FILTERED_DIRECTIONS));
    });
    return sets;
}

}  // namespace

uint32_t FilteredEnvironment::next_size(uint32_t size, uint32_t least) {
    return size > least ? std::max(size / 2, least) : size;
}

FilteredEnvironment::FilteredEnvironment(const Environment& environment) {
    constexpr uint32_t coarse_rows = 64;
    const std::vector<Map> pyramid = pyramid_of(without_spot(environment));
    const Map coarse = coarse_map(pyramid, coarse_rows);
    const std::vector<Patch> patches = patches_of(coarse);
    width = std::max(environment.width / 2, 1u);
    height = std::max(environment.height / 2, 1u);
    levels = 1 + uint32_t(std::max(0.0, std::round(std::log2(double(environment.height) / (2 * kPi)))));
    uint32_t columns = width, rows = height;
    for (uint32_t level = 0; level < levels; level++) {
        const double alpha = std::exp2(double(level) - (levels - 1));
        const std::vector<glm::vec4> lobes = lobe_level(columns, rows, alpha, pyramid, patches);
        texels.insert(texels.end(), lobes.begin(), lobes.end());
        columns = next_size(columns, 2 * FILTERED_LEAST_ROWS);
        rows = next_size(rows, FILTERED_LEAST_ROWS);
    }
    directions = fixed_directions(in_curve(patches, coarse.width, coarse.height));
}

}  // namespace peelray
