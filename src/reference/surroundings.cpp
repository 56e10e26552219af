#include "reference/surroundings.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "path/shading_numbers.h"
#include "reference/optics.h"
#include "scene/sampling.h"

namespace peelray {
namespace {

/// Of a direction in the map, [0, 1]².
glm::dvec2 place(const glm::dvec3& d) {
    return {0.5 + std::atan2(d.x, -d.z) / (2 * optics::pi), std::acos(std::clamp(d.y, -1.0, 1.0)) / optics::pi};
}

/// Takes the first of two ways with the chance `first`; what is left of the random number is one again.
bool choose_first(double& random, double first) {
    constexpr double below_one = 1 - std::numeric_limits<double>::epsilon();
    const bool taken = random < first;
    random = std::min(taken ? random / first : (random - first) / (1 - first), below_one);
    return taken;
}

}  // namespace

glm::dvec3 Surroundings::level(const glm::dvec2& uv, uint32_t level) const {
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
glm::dvec3 Surroundings::picture(const glm::dvec2& uv, size_t offset, uint32_t width, uint32_t height) const {
    return bilinear(uv * glm::dvec2(width, height), [&](int x, int y) {
        const auto column = size_t((x + int(width)) % int(width)), row = size_t(std::clamp(y, 0, int(height) - 1));
        return glm::dvec3(environment_.texels[offset + row * width + column]);
    });
}

glm::dvec3 Surroundings::radiance(const glm::dvec3& d, double blur) const {
    const glm::dvec2 uv = place(d);
    const double exact = blur * (environment_.levels - 1);
    const auto lower = uint32_t(exact), upper = std::min(lower + 1, environment_.levels - 1);
    return exact > lower ? glm::mix(level(uv, lower), level(uv, upper), exact - lower) : level(uv, lower);
}

glm::dvec3 Surroundings::blurred(const glm::dvec3& d) const {
    return picture(place(d), environment_.level_texels(), BLURRED_WIDTH, BLURRED_HEIGHT);
}

double Surroundings::blur_of(double spread) const {
    const double texels = std::abs(spread) * environment_.height / optics::pi;
    if (!environment_.is_pyramid || environment_.levels < 2 || texels <= 1) return 0;
    return std::min(1.0, std::log2(texels) / (environment_.levels - 1));
}

glm::dvec3 Surroundings::seen(const glm::dvec3& d, double blur, bool sees_sun, double rough_limit) const {
    const glm::dvec3 all = radiance(d, blur);
    if (!sees_sun) return all * std::min(1.0, rough_limit / std::max(optics::largest(all), 1e-30));
    const bool sun = glm::dot(d, glm::dvec3(environment_.sun_direction)) >= double(environment_.sun_cosine);
    return sun ? all + glm::dvec3(environment_.sun_radiance) : all;
}

glm::dvec3 Surroundings::irradiance(const glm::dvec3& n) const {
    const double basis[9] = {
        1, n.y, n.z, n.x, n.x * n.y, n.y * n.z, 3 * n.z * n.z - 1, n.x * n.z, n.x * n.x - n.y * n.y};
    glm::dvec3 sum(0);
    for (int i = 0; i < 9; i++) sum += glm::dvec3(environment_.irradiance[size_t(i)]) * basis[i];
    return glm::max(sum, glm::dvec3(0));
}

/// All directions of a cell are alike.
double Surroundings::density_in(const Cell& cell, double probability) const {
    const double rows = 1u << environment_.distribution.depth;
    // The difference of two cosines, as a product: near the poles it is small.
    const double height = 2 * std::sin(optics::pi * (cell.row + 0.5) / rows) * std::sin(optics::pi / (2 * rows));
    return probability / (height * optics::pi / rows);
}

Surroundings::Drawn Surroundings::draw(glm::dvec2 random) const {
    const EnvironmentDistribution& tree = environment_.distribution;
    const glm::dvec4 halves = tree.quads[0];
    uint32_t code = choose_first(random.x, halves.x / (halves.x + halves.y)) ? 0 : 1;
    Cell cell{code, 0};
    double probability = 0;
    for (uint32_t level = 1; level <= tree.depth; level++) {
        const glm::dvec4 quad = tree.quads[EnvironmentDistribution::first(level) + code];
        const double left = quad[0] + quad[2], right = quad[1] + quad[3];
        const uint32_t column = choose_first(random.x, left / (left + right)) ? 0 : 1;
        const uint32_t row = choose_first(random.y, quad[int(column)] / (column == 0 ? left : right)) ? 0 : 1;
        probability = quad[int(column + 2 * row)];
        code = 4 * code + column + 2 * row;
        cell = {2 * cell.column + column, 2 * cell.row + row};
    }
    const double rows = 1u << tree.depth, azimuth = (2 * (cell.column + random.x) / (2 * rows) - 1) * optics::pi;
    const double top = std::cos(optics::pi * cell.row / rows), bottom = std::cos(optics::pi * (cell.row + 1) / rows);
    const double cosine = glm::mix(top, bottom, random.y), sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
    return {{sine * std::sin(azimuth), cosine, -sine * std::cos(azimuth)}, density_in(cell, probability)};
}

double Surroundings::density(const glm::dvec3& direction) const {
    const EnvironmentDistribution& tree = environment_.distribution;
    const uint32_t rows = 1u << tree.depth;
    const glm::dvec2 at = place(direction) * glm::dvec2(2 * rows, rows);
    const Cell cell{std::min(uint32_t(at.x), 2 * rows - 1), std::min(uint32_t(at.y), rows - 1)};
    uint32_t code = cell.column / rows;
    for (uint32_t level = 1; level < tree.depth; level++) {
        const uint32_t below = tree.depth - level;
        code = 4 * code + (cell.column >> below & 1) + 2 * (cell.row >> below & 1);
    }
    const glm::dvec4 quad = tree.quads[EnvironmentDistribution::first(tree.depth) + code];
    return density_in(cell, quad[int((cell.column & 1) + 2 * (cell.row & 1))]);
}

}  // namespace peelray
