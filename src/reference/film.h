// What a thin film on a surface reflects (KHR_materials_iridescence): Airy's sum for each wavelength, added up as the
// eye sees it. Private to src/reference.
#pragma once

#include <glm/glm.hpp>

#include "reference/real.h"

namespace peelray::inline PRECISION::film {

/// Of white light, what of each channel is reflected, [0, 1]: from air by a film of this index and thickness (nm) on
/// something whose index for the channel is `base`; `cosine` in [0, 1]: to the normal, in air.
Vec3 reflectance(real cosine, real index, real thickness, const Vec3& base);

/// Index of what reflects this much at normal incidence in air.
Vec3 index_of(const Vec3& reflectance);

}  // namespace peelray::inline PRECISION::film
