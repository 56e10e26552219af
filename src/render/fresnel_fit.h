// Fresnel's exact reflectance as a sum of powers, so that its mean over a rough surface can be tabulated.
#pragma once

#include <glm/glm.hpp>

namespace peelray {

/// The reflectance of a dielectric of the index `ior` ≥ 1 in air, less what it is at normal incidence, is about the sum
/// of these times the powers of (1 - cosine) in path/split_sum.h, in that order. Right to 0.002 for indices up to 3
/// (0.04 for 10), and the means over rough surfaces to 0.001.
glm::vec3 fresnel_fit(double ior);

}  // namespace peelray
