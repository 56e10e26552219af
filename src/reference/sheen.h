// The sheen of cloth (KHR_materials_sheen): fibres that stand up, by Estevez and Kulla (Production Friendly Microfacet
// Sheen BRDF, 2017). Private to src/reference.
#pragma once

namespace peelray::sheen {

/// The lobe's width for a perceptual roughness.
double alpha_of(double roughness);
/// The lobe times n·l for a sheen of colour 1; the cosines: n·h, n·v and n·l, the last two > 0.
double lobe(double alpha, double n_h, double n_v, double n_l);
/// Of light from everywhere, what is reflected to a viewer, [0, 1]: the lobe's integral, by quadrature.
double albedo(double alpha, double n_v);

}  // namespace peelray::sheen
