// Light from outside the scene, in double precision. Private to src/reference.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "path/filtered_numbers.h"
#include "reference/real.h"
#include "scene/environment.h"

namespace peelray::inline PRECISION {

/// Light from outside the scene; the environment must outlive it.
class Surroundings {
  public:
    explicit Surroundings(const Environment& environment);

    /// Of a unit direction in the map, [0, 1]².
    static Vec2 place(const Vec3& direction);
    /// Radiance from a place without the sun's disc; `blur` in [0, 1]: a surface's roughness.
    Vec3 radiance_at(const Vec2& place, real blur) const;
    /// Has fetched what radiance_at() without blur, and density_at() if `with_density`, will read: it is spread over
    /// megabytes, and what is computed until then takes as long as to fetch it.
    void prefetch(const Vec2& place, bool with_density) const;
    Vec3 radiance(const Vec3& direction, real blur) const { return radiance_at(place(direction), blur); }
    /// The blur of light from a cone that widens by `spread` per world unit; 0 where the levels are no means.
    real blur_of(real spread) const;
    /// What a ray that hits nothing sees; one that does not see the sun sees nothing brighter than `rough_limit`.
    Vec3 seen(const Vec3& direction, real blur, bool sees_sun, real rough_limit) const {
        return seen(direction, place(direction), blur, sees_sun, rough_limit);
    }
    Vec3 seen(const Vec3& direction, const Vec2& place, real blur, bool sees_sun, real rough_limit) const;
    /// What a lobe of this alpha sees around its direction (Environment::filtered, which must not be empty).
    Vec3 filtered(const Vec3& direction, real alpha, real rough_limit) const;
    /// The set of directions of a sample.
    std::span<const FixedDirection> fixed_directions(uint32_t sample) const {
        const size_t first = size_t(sample % FILTERED_SETS) * FILTERED_DIRECTIONS;
        return std::span(environment_.filtered.directions).subspan(first, FILTERED_DIRECTIONS);
    }
    /// What the camera sees of it blurred (Environment::has_blurred).
    Vec3 blurred(const Vec3& direction) const;
    /// Mean over all directions, of the brightest channel.
    real usual() const;
    /// Of the environment on a surface with this normal, from nine harmonics.
    Vec3 irradiance(const Vec3& normal) const;

    /// A direction, the density of such ones, and where it is in the map.
    struct Drawn {
        Vec3 direction;
        real density;
        Vec2 place;
    };
    /// By Environment::distribution, which must not be empty; `random` in [0, 1)².
    Drawn draw(Vec2 random) const;
    /// Of the directions that draw() returns.
    real density_at(const Vec2& place) const;
    real density(const Vec3& direction) const { return density_at(place(direction)); }

  private:
    /// A cell of the distribution, from the map's top left.
    struct Cell {
        uint32_t column, row;
    };
    /// A level of the map: of how many texels, and where they begin.
    struct Level {
        size_t first;
        uint32_t width, height;
    };
    /// Where draw() may begin for the random numbers of a square: the smallest node of the distribution's trees that
    /// all of them lead to, and which ones do.
    struct Entry {
        Vec2 first, scale;  ///< number - first, times scale: [0, 1)²
        uint32_t level, code;
        Cell cell;
    };
    Vec3 filtered_level(const Vec3& direction, uint32_t number) const;
    Vec3 picture(const Vec2& uv, const Level& level) const;
    Cell cell_at(const Vec2& place) const;
    const glm::vec4& leaf(const Cell& cell) const;
    real density_in(const Cell& cell, real probability) const { return probability / cell_sizes_[cell.row]; }
    /// Four leaves of the distribution's trees that are next to each other: what is above them is their sums.
    struct alignas(64) Leaves {
        glm::vec4 quads[4];
    };
    Entry entry_for(uint32_t column, uint32_t row) const;

    /// Squares a side that random numbers are divided into. The reference always begins at the root.
    static constexpr uint32_t entry_sides = is_reference ? 1 : 64;
    const Environment& environment_;
    std::vector<Level> levels_;
    std::vector<real> cosines_, cell_sizes_;  ///< of the distribution's rows: of their upper edges, in steradians
    std::vector<Entry> entries_;
    std::vector<Leaves> leaves_;
};

}  // namespace peelray::inline PRECISION
