// An environment for EnvironmentMode::filtered: what rough surfaces mirror of it, and few directions for all its light.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace peelray {

struct Environment;

/// A direction that stands for a part of an environment.
struct FixedDirection {
    glm::vec3 direction;  ///< unit, to the light
    glm::vec3 light;      ///< of that part, as irradiance on what faces it
};

/// Neither holds the spot of an image for which Environment::lights stand: that is a lamp.
struct FilteredEnvironment {
    /// Levels of what GGX reflects where viewer, normal and mirrored direction are one (Karis 2013), of half the
    /// environment's size, each half that of the one before down to FILTERED_LEAST_ROWS rows. The alpha of the last is
    /// 1, and of each before it half as much.
    uint32_t width = 0, height = 0, levels = 0;
    std::vector<glm::vec4> texels;
    /// FILTERED_SETS sets of FILTERED_DIRECTIONS, one after another, each of which holds all the light.
    std::vector<FixedDirection> directions;

    FilteredEnvironment() = default;
    explicit FilteredEnvironment(const Environment& environment);

    /// Rows or columns of the level after one with so many; `least`: FILTERED_LEAST_ROWS, or twice that.
    static uint32_t next_size(uint32_t size, uint32_t least);
};

}  // namespace peelray
