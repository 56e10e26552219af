// Fresnel's exact reflectance as a sum of powers, so that its mean over a rough surface can be tabulated.
#pragma once

#include <glm/glm.hpp>

namespace peelray {

/// The reflectance of a dielectric of the index `ior` ≥ 1 in air is about the sum of these times the powers of
/// (1 - cosine) in path/tables.h, in that order. The means over rough surfaces are right to 0.001 for indices from
/// 1.1 to 2.4, to 0.005 up to 4, and to 0.045 below 1.1, where it is seen at grazing angles alone.
glm::vec4 fresnel_fit(double ior);

}  // namespace peelray
