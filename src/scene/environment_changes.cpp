// Environments turned, dimmed and blurred.
#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "path/shading_numbers.h"
#include "scene/environment.h"
#include "scene/pi.h"
#include "scene/sampling.h"

namespace peelray {
namespace {

/// Calls `visit(first texel, width, height)` for each level.
template <typename Visit>
void for_levels(const Environment& environment, Visit visit) {
    size_t offset = 0;
    uint32_t width = environment.width, height = environment.height;
    for (uint32_t level = 0; level < environment.levels; level++) {
        visit(offset, width, height);
        offset += size_t(width) * height;
        width = std::max(width / 2, 1u);
        height = std::max(height / 2, 1u);
    }
}

/// Each texel becomes what lies `shift` texels, [0, width), to the right of it.
void shift_row(glm::vec4* row, uint32_t width, double shift) {
    std::rotate(row, row + uint32_t(shift), row + width);
    const float part = float(shift - std::floor(shift));
    if (part == 0) return;
    const glm::vec4 first = row[0];
    for (uint32_t x = 0; x < width; x++) row[x] = glm::mix(row[x], x + 1 < width ? row[x + 1] : first, part);
}

/// Harmonics of the irradiance as the environment turns with `turn`: the linear ones are a vector, those of degree two
/// a symmetric matrix M without a trace, of the form nᵀ M n.
void rotate_irradiance(std::array<glm::vec3, 9>& irradiance, const glm::dmat3& turn) {
    for (int c = 0; c < 3; c++) {
        double e[9];
        for (int i = 0; i < 9; i++) e[i] = double(irradiance[size_t(i)][c]);
        const glm::dvec3 linear = turn * glm::dvec3(e[3], e[1], e[2]);
        const glm::dmat3 before(e[8] - e[6], e[4] / 2, e[7] / 2,   //
                                e[4] / 2, -e[8] - e[6], e[5] / 2,  //
                                e[7] / 2, e[5] / 2, 2 * e[6]);
        const glm::dmat3 m = turn * before * glm::transpose(turn);
        const double after[9] = {e[0],        linear.y,    linear.z,
                                 linear.x,    2 * m[0][1], 2 * m[1][2],
                                 m[2][2] / 2, 2 * m[0][2], (m[0][0] - m[1][1]) / 2};
        for (int i = 0; i < 9; i++) irradiance[size_t(i)][c] = float(after[i]);
    }
}

/// A coarse picture: rows from the top, as radiance.
struct Coarse {
    uint32_t width = 0, height = 0;
    std::vector<glm::dvec3> texels;

    /// Between texels, as tracers look levels up; x and y in [0, 1].
    glm::dvec3 at(double x, double y) const {
        return bilinear_around(glm::dvec2(x, y), width, height, [&](size_t i) { return texels[i]; });
    }
};

/// Of the blurred picture's size, from the first level that is no finer.
Coarse coarse_picture(const Environment& environment) {
    Coarse level;
    for_levels(environment, [&](size_t offset, uint32_t width, uint32_t height) {
        if (level.width > 0 && level.width <= BLURRED_WIDTH) return;
        const auto first = environment.texels.begin() + ptrdiff_t(offset);
        level = {width, height, {first, first + ptrdiff_t(size_t(width) * height)}};
    });
    Coarse coarse{BLURRED_WIDTH, BLURRED_HEIGHT, {}};
    for (uint32_t y = 0; y < BLURRED_HEIGHT; y++)
        for (uint32_t x = 0; x < BLURRED_WIDTH; x++)
            coarse.texels.push_back(level.at((x + 0.5) / BLURRED_WIDTH, (y + 0.5) / BLURRED_HEIGHT));
    return coarse;
}

/// Polar angle of the middle of a row.
double polar_angle(uint32_t row) {
    return (row + 0.5) * kPi / BLURRED_HEIGHT;
}

/// What the texels of row `from` weigh in row `to`, by how many columns lie in between.
std::vector<double> blur_weights(uint32_t to, uint32_t from) {
    std::vector<double> weights;
    const double here = polar_angle(to), there = polar_angle(from);
    for (uint32_t columns = 0; columns < BLURRED_WIDTH; columns++) {
        const double turn = 2 * kPi * columns / BLURRED_WIDTH;
        const double cosine = std::cos(here) * std::cos(there) + std::sin(here) * std::sin(there) * std::cos(turn);
        const double angle = std::acos(std::clamp(cosine, -1.0, 1.0)) / BLURRED_RADIANS;
        weights.push_back(std::sin(there) * std::exp(-0.5 * angle * angle));
    }
    return weights;
}

void blur_row(const Coarse& coarse, uint32_t row, glm::vec4* out) {
    constexpr double deviations = 4;  // beyond them nothing counts
    std::vector<glm::dvec3> sums(BLURRED_WIDTH, glm::dvec3(0));
    double whole = 0;
    for (uint32_t from = 0; from < BLURRED_HEIGHT; from++) {
        // No texel of a row is nearer than its polar angle is.
        if (std::abs(polar_angle(row) - polar_angle(from)) > deviations * BLURRED_RADIANS) continue;
        const std::vector<double> weights = blur_weights(row, from);
        for (const double weight : weights) whole += weight;
        for (uint32_t x = 0; x < BLURRED_WIDTH; x++)
            for (uint32_t k = 0; k < BLURRED_WIDTH; k++)
                sums[x] +=
                    weights[(x + BLURRED_WIDTH - k) % BLURRED_WIDTH] * coarse.texels[size_t(from) * BLURRED_WIDTH + k];
    }
    for (uint32_t x = 0; x < BLURRED_WIDTH; x++) out[x] = glm::vec4(glm::vec3(sums[x] / whole), 1);
}

}  // namespace

size_t Environment::level_texels() const {
    size_t count = 0;
    for_levels(*this, [&](size_t, uint32_t width, uint32_t height) { count += size_t(width) * height; });
    return count;
}

void rotate(Environment& environment, double degrees) {
    degrees = std::fmod(degrees, 360);
    if (degrees < 0) degrees += 360;
    if (degrees == 0) return;
    for_levels(environment, [&](size_t offset, uint32_t width, uint32_t height) {
        // Columns go clockwise: what turns to the left comes from the right.
        const double shift = std::fmod(degrees / 360 * width, double(width));
        parallel_for(height, 64, [&](size_t y) { shift_row(&environment.texels[offset + y * width], width, shift); });
    });
    const double angle = degrees * kPi / 180, c = std::cos(angle), s = std::sin(angle);
    const glm::dmat3 turn(c, 0, -s, 0, 1, 0, s, 0, c);
    rotate_irradiance(environment.irradiance, turn);
    environment.sun_direction = glm::vec3(turn * glm::dvec3(environment.sun_direction));
    for (Light& light : environment.lights) light.direction = glm::vec3(turn * glm::dvec3(light.direction));
}

void scale(Environment& environment, float factor) {
    if (factor == 1) return;
    parallel_for(environment.texels.size(), 4096, [&](size_t i) {
        glm::vec4& texel = environment.texels[i];
        texel = glm::vec4(glm::vec3(texel) * factor, texel.w);
    });
    for (glm::vec3& harmonic : environment.irradiance) harmonic *= factor;
    environment.sun_radiance *= factor;
    environment.rough_limit *= factor;
    for (Light& light : environment.lights) light.color *= factor;
}

void add_blurred(Environment& environment) {
    const Coarse coarse = coarse_picture(environment);
    const size_t first = environment.texels.size();
    environment.texels.resize(first + size_t(BLURRED_WIDTH) * BLURRED_HEIGHT);
    parallel_for(BLURRED_HEIGHT, 1, [&](size_t row) {
        blur_row(coarse, uint32_t(row), &environment.texels[first + row * BLURRED_WIDTH]);
    });
    environment.has_blurred = true;
}

}  // namespace peelray
