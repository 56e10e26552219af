// The sheen of cloth (KHR_materials_sheen): fibres that stand up, by Estevez and Kulla (Production Friendly Microfacet
// Sheen BRDF, 2017). Private to src/reference.
#pragma once

#include "reference/real.h"

namespace peelray::inline PRECISION::sheen {

/// The lobe's width for a perceptual roughness.
real alpha_of(real roughness);
/// The lobe times n·l for a sheen of colour 1; the cosines: n·h, n·v and n·l, the last two > 0.
real lobe(real alpha, real n_h, real n_v, real n_l);
/// Of light from everywhere, what is reflected to a viewer, [0, 1]: the lobe's integral, by quadrature.
real albedo(real alpha, real n_v);

}  // namespace peelray::inline PRECISION::sheen
