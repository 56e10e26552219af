// Light from outside the scene, in double precision. Private to src/reference.
#pragma once

#include <glm/glm.hpp>

#include "scene/environment.h"

namespace peelray {

/// Light from outside the scene; the environment must outlive it.
class Surroundings {
  public:
    explicit Surroundings(const Environment& environment) : environment_(environment) {}

    /// Radiance along a unit direction without the sun's disc; `blur` in [0, 1]: a surface's roughness.
    glm::dvec3 radiance(const glm::dvec3& direction, double blur) const;
    /// The blur of light from a cone that widens by `spread` per world unit; 0 where the levels are no means.
    double blur_of(double spread) const;
    /// What a ray that hits nothing sees; one that does not see the sun sees nothing brighter than `rough_limit`.
    glm::dvec3 seen(const glm::dvec3& direction, double blur, bool sees_sun, double rough_limit) const;
    /// What the camera sees of it blurred (Environment::has_blurred).
    glm::dvec3 blurred(const glm::dvec3& direction) const;
    /// Of the environment on a surface with this normal, from nine harmonics.
    glm::dvec3 irradiance(const glm::dvec3& normal) const;

    /// A direction, and the density of such ones.
    struct Drawn {
        glm::dvec3 direction;
        double density;
    };
    /// By Environment::distribution, which must not be empty; `random` in [0, 1)².
    Drawn draw(glm::dvec2 random) const;
    /// Of the directions that draw() returns.
    double density(const glm::dvec3& direction) const;

  private:
    /// A cell of the distribution, from the map's top left.
    struct Cell {
        uint32_t column, row;
    };
    glm::dvec3 level(const glm::dvec2& uv, uint32_t level) const;
    glm::dvec3 picture(const glm::dvec2& uv, size_t offset, uint32_t width, uint32_t height) const;
    double density_in(const Cell& cell, double probability) const;

    const Environment& environment_;
};

}  // namespace peelray
