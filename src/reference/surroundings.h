// Light from outside the scene, in double precision. Private to src/reference.
#pragma once

#include <glm/glm.hpp>
#include <span>

#include "path/filtered_numbers.h"
#include "reference/real.h"
#include "scene/environment.h"

namespace peelray::inline PRECISION {

/// Light from outside the scene; the environment must outlive it.
class Surroundings {
  public:
    explicit Surroundings(const Environment& environment) : environment_(environment) {}

    /// Radiance along a unit direction without the sun's disc; `blur` in [0, 1]: a surface's roughness.
    Vec3 radiance(const Vec3& direction, real blur) const;
    /// The blur of light from a cone that widens by `spread` per world unit; 0 where the levels are no means.
    real blur_of(real spread) const;
    /// What a ray that hits nothing sees; one that does not see the sun sees nothing brighter than `rough_limit`.
    Vec3 seen(const Vec3& direction, real blur, bool sees_sun, real rough_limit) const;
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

    /// A direction, and the density of such ones.
    struct Drawn {
        Vec3 direction;
        real density;
    };
    /// By Environment::distribution, which must not be empty; `random` in [0, 1)².
    Drawn draw(Vec2 random) const;
    /// Of the directions that draw() returns.
    real density(const Vec3& direction) const;

  private:
    /// A cell of the distribution, from the map's top left.
    struct Cell {
        uint32_t column, row;
    };
    static Vec2 place(const Vec3& direction);
    Vec3 filtered_level(const Vec3& direction, uint32_t number) const;
    Vec3 level(const Vec2& uv, uint32_t level) const;
    Vec3 picture(const Vec2& uv, size_t offset, uint32_t width, uint32_t height) const;
    real density_in(const Cell& cell, real probability) const;

    const Environment& environment_;
};

}  // namespace peelray::inline PRECISION
