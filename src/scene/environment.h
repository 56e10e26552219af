// Where light comes from on a miss: an image, a procedural sky or a colour. Shared by every tracer.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "scene/filtered_environment.h"
#include "scene/light_distribution.h"
#include "scene/scene.h"

namespace peelray {

/// An environment map in equirectangular form with what shading needs of it. The image's centre looks along -z, its
/// right edge continues at its left; the top row is +y.
struct Environment {
    uint32_t width = 0, height = 0, levels = 0;
    std::vector<glm::vec4>
        texels;  ///< all levels, finest first, each half the size (rounded down, at least 1) of the one before
    std::array<glm::vec3, 9>
        irradiance{};  ///< E(n) as factors of 1, y, z, x, xy, yz, 3z²-1, xz, x²-y² (Ramamoorthi, Hanrahan 2001)
    glm::vec3 sun_direction{0, 1, 0};  ///< unit, to the sun
    glm::vec3 sun_radiance{0};         ///< of its disc, which the texels do not hold
    float sun_cosine = 2;              ///< cosine of the disc's angular radius; 2: no disc
    float rough_limit = 1e30f;  ///< radiance above this belongs to `lights`: rays after a rough surface see no more
    std::vector<Light> lights;  ///< directional lights that stand for the sun or the image's brightest spot
    bool is_image = false;      ///< of which `lights` stand for a part; else they add to the texels
    bool is_pyramid = false;    ///< its levels are means of the one before: what a wider ray sees
    EnvironmentDistribution distribution;  ///< of the texels; empty unless EnvironmentMode::sampled
    FilteredEnvironment filtered;          ///< empty unless EnvironmentMode::filtered
    bool has_blurred = false;  ///< BLURRED_WIDTH·BLURRED_HEIGHT texels more, see add_blurred(), follow the levels

    /// Texels of all levels: where the blurred picture begins, if there is one.
    size_t level_texels() const;
};

/// A clear sky over grey ground with the sun at `sun_direction` (unit, to the sun). Made for pleasant pictures, not for
/// measured ones: sun and sky give a horizontal surface about 3.6 and 1.6 units of irradiance.
Environment sky_environment(const glm::vec3& sun_direction);

/// The sun's direction when the user gives none.
glm::vec3 default_sun_direction();

/// A photographer's studio, for files that bring no light: soft boxes before a grey backdrop that is brightest at its
/// horizon. What faces the framed view's camera gets an irradiance of about pi, so that a grey of 18 % looks like one,
/// and nothing more than 1.3 times that. No light stands for a spot of it. Its levels are what GGX of growing roughness
/// reflects.
Environment studio_environment();

/// The same radiance from everywhere.
Environment color_environment(const glm::vec3& radiance);

/// An equirectangular image (row 0 at the top). If a spot of it outshines everything else (a sun), a directional light
/// takes its place in the diffuse light, so that it casts shadows; reflections still see the image as it is.
Environment image_environment(uint32_t width, uint32_t height, std::span<const glm::vec4> pixels);
/// The same without a copy of the pixels, which large images are spared.
Environment image_environment(uint32_t width, uint32_t height, std::vector<glm::vec4>&& pixels);

/// Turns all of it around +y, counter-clockwise as seen from above. Turns by whole texels only move them; others
/// interpolate along the rows. `degrees`: finite.
void rotate(Environment& environment, double degrees);

/// Makes all of it `factor` times as bright, from 0 up.
void scale(Environment& environment, float factor);

/// Adds the picture that a camera is to see of it blurred: the mean over BLURRED_RADIANS around each direction
/// (path/shading_numbers.h), by the density of a normal distribution; the sun's disc, which no texel holds, is left
/// out. Once, and last: rotate() and scale() do not know of it.
void add_blurred(Environment& environment);

/// Unit direction of an equirectangular position (u, v in [0, 1]).
glm::vec3 environment_direction(float u, float v);

}  // namespace peelray
