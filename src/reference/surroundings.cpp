#include "reference/surroundings.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "path/shading_numbers.h"
#include "reference/optics.h"
#include "scene/sampling.h"

namespace peelray::inline PRECISION {
namespace {

/// Takes the first of two ways with the chance `first`; what is left of the random number is one again.
bool choose_first(real& random, real first) {
    const bool taken = random < first;
    random = std::min(taken ? random / first : (random - first) / (1 - first), below_one);
    return taken;
}

}  // namespace

/// Of a direction in the map, [0, 1]².
Vec2 Surroundings::place(const Vec3& d) {
    return {0.5 + std::atan2(d.x, -d.z) / (2 * optics::pi), std::acos(std::clamp(d.y, -1.0, 1.0)) / optics::pi};
}

Vec3 Surroundings::level(const Vec2& uv, uint32_t level) const {
    size_t offset = 0;
    uint32_t width = environment_.width, height = environment_.height;
    for (uint32_t i = 0; i < level; i++) {
        offset += size_t(width) * height;
        width = std::max(width / 2, 1u);
        height = std::max(height / 2, 1u);
    }
    return picture(uv, offset, width, height);
}

/// A picture among the texels, between them.
Vec3 Surroundings::picture(const Vec2& uv, size_t offset, uint32_t width, uint32_t height) const {
    return bilinear_around(uv, width, height, [&](size_t i) { return Vec3(environment_.texels[offset + i]); });
}

Vec3 Surroundings::radiance(const Vec3& d, real blur) const {
    const Vec2 uv = place(d);
    const real exact = blur * (environment_.levels - 1);
    const auto lower = uint32_t(exact), upper = std::min(lower + 1, environment_.levels - 1);
    return exact > lower ? glm::mix(level(uv, lower), level(uv, upper), exact - lower) : level(uv, lower);
}

Vec3 Surroundings::blurred(const Vec3& d) const {
    return picture(place(d), environment_.level_texels(), BLURRED_WIDTH, BLURRED_HEIGHT);
}

real Surroundings::blur_of(real spread) const {
    const real texels = std::abs(spread) * environment_.height / optics::pi;
    if (!environment_.is_pyramid || environment_.levels < 2 || texels <= 1) return 0;
    return std::min(1.0, std::log2(texels) / (environment_.levels - 1));
}

Vec3 Surroundings::seen(const Vec3& d, real blur, bool sees_sun, real rough_limit) const {
    const Vec3 all = radiance(d, blur);
    if (!sees_sun) return all * std::min(1.0, rough_limit / std::max(optics::largest(all), 1e-30));
    const bool sun = glm::dot(d, Vec3(environment_.sun_direction)) >= real(environment_.sun_cosine);
    return sun ? all + Vec3(environment_.sun_radiance) : all;
}

Vec3 Surroundings::irradiance(const Vec3& n) const {
    const real basis[9] = {1, n.y, n.z, n.x, n.x * n.y, n.y * n.z, 3 * n.z * n.z - 1, n.x * n.z, n.x * n.x - n.y * n.y};
    Vec3 sum(0);
    for (int i = 0; i < 9; i++) sum += Vec3(environment_.irradiance[size_t(i)]) * basis[i];
    return glm::max(sum, Vec3(0));
}

real Surroundings::usual() const {
    return std::max(0.0, optics::largest(Vec3(environment_.irradiance[0])) / optics::pi);
}

/// All directions of a cell are alike.
real Surroundings::density_in(const Cell& cell, real probability) const {
    const real rows = 1u << environment_.distribution.depth;
    // The difference of two cosines, as a product: near the poles it is small.
    const real height = 2 * std::sin(optics::pi * (cell.row + 0.5) / rows) * std::sin(optics::pi / (2 * rows));
    return probability / (height * optics::pi / rows);
}

Surroundings::Drawn Surroundings::draw(Vec2 random) const {
    const EnvironmentDistribution& tree = environment_.distribution;
    const Vec4 halves = tree.quads[0];
    uint32_t code = choose_first(random.x, halves.x / (halves.x + halves.y)) ? 0 : 1;
    Cell cell{code, 0};
    real probability = 0;
    for (uint32_t level = 1; level <= tree.depth; level++) {
        const Vec4 quad = tree.quads[EnvironmentDistribution::first(level) + code];
        const real left = quad[0] + quad[2], right = quad[1] + quad[3];
        const uint32_t column = choose_first(random.x, left / (left + right)) ? 0 : 1;
        const uint32_t row = choose_first(random.y, quad[int(column)] / (column == 0 ? left : right)) ? 0 : 1;
        probability = quad[int(column + 2 * row)];
        code = 4 * code + column + 2 * row;
        cell = {2 * cell.column + column, 2 * cell.row + row};
    }
    const real rows = 1u << tree.depth, azimuth = (2 * (cell.column + random.x) / (2 * rows) - 1) * optics::pi;
    const real top = std::cos(optics::pi * cell.row / rows), bottom = std::cos(optics::pi * (cell.row + 1) / rows);
    const real cosine = glm::mix(top, bottom, random.y), sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
    return {{sine * std::sin(azimuth), cosine, -sine * std::cos(azimuth)}, density_in(cell, probability)};
}

real Surroundings::density(const Vec3& direction) const {
    const EnvironmentDistribution& tree = environment_.distribution;
    const uint32_t rows = 1u << tree.depth;
    const Vec2 at = place(direction) * Vec2(2 * rows, rows);
    const Cell cell{std::min(uint32_t(at.x), 2 * rows - 1), std::min(uint32_t(at.y), rows - 1)};
    uint32_t code = cell.column / rows;
    for (uint32_t level = 1; level < tree.depth; level++) {
        const uint32_t below = tree.depth - level;
        code = 4 * code + (cell.column >> below & 1) + 2 * (cell.row >> below & 1);
    }
    const Vec4 quad = tree.quads[EnvironmentDistribution::first(tree.depth) + code];
    return density_in(cell, quad[int((cell.column & 1) + 2 * (cell.row & 1))]);
}

}  // namespace peelray::inline PRECISION
