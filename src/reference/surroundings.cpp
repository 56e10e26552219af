#include "reference/surroundings.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "path/shading_numbers.h"
#include "reference/arcs.h"
#include "reference/optics.h"
#include "scene/sampling.h"

namespace peelray::inline PRECISION {
namespace {

/// Takes the first of two ways with the chance `first`; what is left of the random number is one again. Which way is
/// taken cannot be foretold: no branch is to wait for it.
bool choose_first(real& random, real first) {
    const bool taken = random < first;
    random = std::min((taken ? random : random - first) / (taken ? first : 1 - first), below_one);
    return taken;
}

}  // namespace

Surroundings::Surroundings(const Environment& environment) : environment_(environment) {
    Level level{0, environment.width, environment.height};
    for (uint32_t i = 0; i < environment.levels; i++) {
        levels_.push_back(level);
        level = {level.first + size_t(level.width) * level.height, std::max(level.width / 2, 1u),
                 std::max(level.height / 2, 1u)};
    }
    if (environment.distribution.quads.empty()) return;
    const uint32_t rows = 1u << environment.distribution.depth;
    for (uint32_t row = 0; row <= rows; row++) {
        cosines_.push_back(std::cos(optics::pi * row / real(rows)));
        // The difference of two cosines, as a product: near the poles it is small.
        const real height = 2 * std::sin(optics::pi * (row + 0.5) / rows) * std::sin(optics::pi / (2 * real(rows)));
        cell_sizes_.push_back(height * optics::pi / rows);
    }
    const auto leaf =
        environment.distribution.quads.begin() + EnvironmentDistribution::first(environment.distribution.depth);
    leaves_.resize(size_t(environment.distribution.quads.end() - leaf) / 4);
    for (size_t i = 0; i < leaves_.size(); i++) std::copy_n(leaf + std::ptrdiff_t(4 * i), 4, leaves_[i].quads);
    for (uint32_t i = 0; i < entry_sides * entry_sides; i++)
        entries_.push_back(entry_for(i % entry_sides, i / entry_sides));
}

/// Down the trees as long as all of a square goes the same way.
Surroundings::Entry Surroundings::entry_for(uint32_t column, uint32_t row) const {
    const EnvironmentDistribution& tree = environment_.distribution;
    /// Of random numbers: the square, and what is left of it in a node.
    struct Range {
        double first, end;
        /// 0: all of it is before the split, 1: behind it.
        std::optional<uint32_t> side(double split) const {
            if (end <= split) return 0;
            if (first >= split) return 1;
            return {};
        }
    };
    struct Node {
        double first = 0, size = 1;
        double split(double share) const { return first + size * share; }
        void enter(uint32_t side, double share) {
            if (side == 1) first += size * share;
            size *= side == 0 ? share : 1 - share;
        }
    };
    const Range x{double(column) / entry_sides, double(column + 1) / entry_sides},
        y{double(row) / entry_sides, double(row + 1) / entry_sides};
    Node across, down;
    Entry entry{Vec2(0), Vec2(1), 0, 0, {0, 0}};
    const glm::dvec4 halves(tree.quads[0]);
    const double share = halves.x / (halves.x + halves.y);
    const auto half = x.side(share);
    if (entry_sides > 1 && half) {
        across.enter(*half, share);
        entry.level = 1;
        entry.code = entry.cell.column = *half;
    }
    while (entry.level > 0 && entry.level + 1 < tree.depth) {
        const glm::dvec4 quad(tree.quads[EnvironmentDistribution::first(entry.level) + entry.code]);
        const double left = quad[0] + quad[2], right = quad[1] + quad[3], left_share = left / (left + right);
        const auto go_right = x.side(across.split(left_share));
        if (!go_right) break;
        const double upper_share = quad[int(*go_right)] / (*go_right ? right : left);
        const auto go_down = y.side(down.split(upper_share));
        if (!go_down) break;
        across.enter(*go_right, left_share);
        down.enter(*go_down, upper_share);
        entry.level++;
        entry.code = 4 * entry.code + *go_right + 2 * *go_down;
        entry.cell = {2 * entry.cell.column + *go_right, 2 * entry.cell.row + *go_down};
    }
    entry.first = Vec2(across.first, down.first);
    entry.scale = Vec2(1 / across.size, 1 / down.size);
    return entry;
}

Vec2 Surroundings::place(const Vec3& d) {
    return {0.5 + arc_tangent(d.x, -d.z) / (2 * optics::pi), arc_cosine(std::clamp(d.y, -1.0, 1.0)) / optics::pi};
}

/// Between the texels of a picture.
Vec3 Surroundings::picture(const Vec2& uv, const Level& level) const {
    const glm::vec4* const texels = environment_.texels.data() + level.first;
    return bilinear_around(uv, level.width, level.height, [&](size_t i) { return Vec3(texels[i]); });
}

Vec3 Surroundings::radiance_at(const Vec2& uv, real blur) const {
    const real exact = blur * (environment_.levels - 1);
    const auto lower = uint32_t(exact), upper = std::min(lower + 1, environment_.levels - 1);
    const Vec3 sharp = picture(uv, levels_[lower]);
    return exact > lower ? glm::mix(sharp, picture(uv, levels_[upper]), exact - lower) : sharp;
}

Vec3 Surroundings::blurred(const Vec3& d) const {
    return picture(place(d), {environment_.level_texels(), BLURRED_WIDTH, BLURRED_HEIGHT});
}

real Surroundings::blur_of(real spread) const {
    const real texels = std::abs(spread) * environment_.height / optics::pi;
    if (!environment_.is_pyramid || environment_.levels < 2 || texels <= 1) return 0;
    return std::min(1.0, std::log2(texels) / (environment_.levels - 1));
}

Vec3 Surroundings::seen(const Vec3& d, const Vec2& place, real blur, bool sees_sun, real rough_limit) const {
    const Vec3 all = radiance_at(place, blur);
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

Surroundings::Drawn Surroundings::draw(Vec2 random) const {
    const EnvironmentDistribution& tree = environment_.distribution;
    const uint32_t square = uint32_t(int(random.x * entry_sides)) + entry_sides * uint32_t(int(random.y * entry_sides));
    const Entry& entry = entries_[square];
    uint32_t level = entry.level, code = entry.code;
    Cell cell = entry.cell;
    if (level == 0) {
        const Vec4 halves = tree.quads[0];
        code = cell.column = choose_first(random.x, halves.x / (halves.x + halves.y)) ? 0 : 1;
        level = 1;
    } else {
        random = glm::clamp((random - entry.first) * entry.scale, Vec2(0), Vec2(below_one));
    }
    real probability = 0;
    const auto enter = [&](const glm::vec4& quad) {
        const real left = real(quad[0]) + quad[2], right = real(quad[1]) + quad[3];
        const uint32_t column = choose_first(random.x, left / (left + right)) ? 0 : 1;
        const uint32_t row = choose_first(random.y, quad[int(column)] / (column == 0 ? left : right)) ? 0 : 1;
        probability = quad[int(column + 2 * row)];
        code = 4 * code + column + 2 * row;
        cell = {2 * cell.column + column, 2 * cell.row + row};
    };
    for (; level + (is_reference ? 0 : 2) <= tree.depth; level++)
        enter(tree.quads[EnvironmentDistribution::first(level) + code]);
    if (!is_reference) {
        // The last two levels from one line of memory.
        const Leaves& leaves = leaves_[code];
        const auto sum = [](const glm::vec4& quad) { return (quad[0] + quad[1]) + (quad[2] + quad[3]); };
        enter({sum(leaves.quads[0]), sum(leaves.quads[1]), sum(leaves.quads[2]), sum(leaves.quads[3])});
        enter(leaves.quads[code & 3]);
    }
    const real rows = 1u << tree.depth, across = (cell.column + random.x) / (2 * rows),
               azimuth = (2 * across - 1) * optics::pi;
    const real cosine = glm::mix(cosines_[cell.row], cosines_[cell.row + 1], random.y),
               sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
    const Vec3 direction(sine * std::sin(azimuth), cosine, -sine * std::cos(azimuth));
    const Vec2 at = is_reference ? place(direction) : Vec2(across, arc_cosine(cosine) / optics::pi);
    return {direction, density_in(cell, probability), at};
}

Surroundings::Cell Surroundings::cell_at(const Vec2& place) const {
    const uint32_t rows = 1u << environment_.distribution.depth;
    const Vec2 at = place * Vec2(2 * rows, rows);
    return {std::min(uint32_t(int(at.x)), 2 * rows - 1), std::min(uint32_t(int(at.y)), rows - 1)};
}

/// The quad that a cell is in.
const glm::vec4& Surroundings::leaf(const Cell& cell) const {
    const uint32_t depth = environment_.distribution.depth, rows = 1u << depth, half = cell.column >> depth;
    const uint32_t code =
        (half << 2 * (depth - 1)) + EnvironmentDistribution::morton((cell.column & (rows - 1)) >> 1, cell.row >> 1);
    return leaves_[code / 4].quads[code & 3];
}

/// All directions of a cell are alike.
real Surroundings::density_at(const Vec2& place) const {
    const Cell cell = cell_at(place);
    return density_in(cell, leaf(cell)[int((cell.column & 1) + 2 * (cell.row & 1))]);
}

void Surroundings::prefetch(const Vec2& place, bool with_density) const {
    if (is_reference) return;
    const int width = int(environment_.width), last = int(environment_.height) - 1;
    const int x = std::clamp(int(place.x * width - 0.5), 0, width - 1), y = int(place.y * (last + 1) - 0.5);
    const size_t upper = size_t(std::clamp(y, 0, last) * width + x),
                 lower = size_t(std::clamp(y + 1, 0, last) * width + x);
    __builtin_prefetch(&environment_.texels[upper]);
    __builtin_prefetch(&environment_.texels[lower]);
    if (with_density) __builtin_prefetch(&leaf(cell_at(place)));
}

}  // namespace peelray::inline PRECISION
