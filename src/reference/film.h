// What a thin film on a surface reflects (KHR_materials_iridescence): Airy's sum for each wavelength, added up as the
// eye sees it. Private to src/reference.
#pragma once

#include <glm/glm.hpp>

namespace peelray::film {

/// Of white light, what of each channel is reflected, [0, 1]: from air by a film of this index and thickness (nm) on
/// something whose index for the channel is `base`; `cosine` in [0, 1]: to the normal, in air.
glm::dvec3 reflectance(double cosine, double index, double thickness, const glm::dvec3& base);

/// Index of what reflects this much at normal incidence in air.
glm::dvec3 index_of(const glm::dvec3& reflectance);

}  // namespace peelray::film
