// From radiance to what a display shows, in double precision; the GPU's pass of the same rules is
// shaders/path/accumulate.comp.
#pragma once

#include "scene/picture.h"

namespace peelray {

/// Of one channel, [0, 1] (IEC 61966-2-1).
double srgb_to_linear(double encoded);
double linear_to_srgb(double linear);

/// Exposed linear light to [0, 1].
glm::dvec3 tone_curve(glm::dvec3 color, Tonemap tonemap);

/// A pixel of the encoded picture: exposed by `exposure` stops, tone-mapped, 8-bit sRGB, red in the lowest byte,
/// opaque. `unlit`: what is added to it as it is, linear (KHR_materials_unlit).
uint32_t encode(const glm::dvec3& radiance, double exposure, Tonemap tonemap, const glm::dvec3& unlit = glm::dvec3(0));

/// The same of a pixel of which only a part, `alpha`, is covered, with that alpha and the colour of the part: what is
/// premultiplied, `radiance` and `unlit`, is divided by it. Nothing covered: 0.
uint32_t encode_straight(const glm::dvec3& radiance, double alpha, double exposure, Tonemap tonemap,
                         const glm::dvec3& unlit = glm::dvec3(0));

}  // namespace peelray
