// Fresnel's exact reflectance as a sum of powers, so that its mean over a rough surface can be tabulated.
#pragma once

#include <glm/glm.hpp>

namespace peelray {

/// The reflectance of a dielectric of the index `ior` ≥ 1 in air is about the sum of these times the powers of
/// (1 - cosine) in path/split_sum.h, in that order.
glm::vec4 fresnel_fit(double ior);

}  // namespace peelray
