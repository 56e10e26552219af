// How far two pictures are apart. All take pictures of the same size, at least one pixel, else they throw Error naming
// both sizes. Alpha is ignored. Results do not depend on the number of cores.
#pragma once

#include <optional>
#include <vector>

#include "image/image.h"

namespace peelray {

/// Peak signal-to-noise ratio of the encoded pictures, dB, over all pixels and the three channels; +inf: equal.
double psnr(const Image8& reference, const Image8& test);

/// Structural similarity of the luma (Rec. 709) of the encoded pictures, in [-1, 1], 1: equal (Wang et al., "Image
/// Quality Assessment: From Error Visibility to Structural Similarity", 2004): Gaussian window of 11×11 pixels,
/// sigma 1.5, K1 0.01, K2 0.03; the mean over all window positions inside the picture. A picture of less than 11 pixels
/// across or down has a window of its own size there.
double ssim(const Image8& reference, const Image8& test);

/// Share of the pixels, [0, 1], of which a channel differs by more than 1/255.
double share_different(const Image8& reference, const Image8& test);

/// An error map: width·height values in [0, 1], row 0 at the top.
struct ErrorMap {
    uint32_t width = 0, height = 0;
    std::vector<float> values;
    double mean() const;
};

/// Pixels per degree of visual angle that FLIP assumes by default: a 0.7 m wide monitor of 3840 pixels at 0.7 m.
double default_pixels_per_degree();

/// LDR-FLIP (Andersson et al., "FLIP: A Difference Evaluator for Alternating Images", HPG 2020) of sRGB-encoded
/// pictures. Symmetric. Throws Error for pixels_per_degree below 1, where the filters vanish, or above 10^4.
ErrorMap flip(const Image8& reference, const Image8& test, double pixels_per_degree = default_pixels_per_degree());

/// The exposures, in stops, between which HDR-FLIP compares.
struct ExposureRange {
    double start, stop;
};
/// Those that the reference asks for (Andersson et al. 2021, tone curve ACES): the largest luminance, then the median
/// one, comes out at 0.85. The median is at least the float epsilon; a black picture has {0, 0}.
ExposureRange flip_exposures(const Image& reference);

/// HDR-FLIP (Andersson et al., "Visualizing Errors in Rendered High Dynamic Range Images", Eurographics 2021): the
/// largest LDR-FLIP per pixel over exposures from `range.start` to `range.stop` (default: flip_exposures()) in steps of
/// about a stop, each tone-mapped with ACES. Linear Rec. 709 pictures; negative values and NaN count as 0, infinity as
/// the largest half (65504), as read_hdr() has it. Throws Error for a range that runs backwards, is not finite or
/// exceeds 300 stops.
ErrorMap hdr_flip(const Image& reference, const Image& test, double pixels_per_degree = default_pixels_per_degree(),
                  std::optional<ExposureRange> range = std::nullopt);

/// An error map in colours: the magma map, black 0 to light yellow 1 (beyond that range, and for NaN, as at its end).
Image8 colorize(const ErrorMap& map);

/// All of it for two pictures of the same scene, as encoded and as radiance, all four of one size.
struct Difference {
    double psnr = 0, ssim = 1, flip = 0, hdr_flip = 0;  ///< flip, hdr_flip: means
    double different = 0;                               ///< share_different()
    ErrorMap map;                                       ///< of LDR-FLIP
};
Difference compare(const Image8& reference, const Image8& test, const Image& reference_radiance,
                   const Image& test_radiance);
/// Of pictures whose radiance is not known: hdr_flip is NaN.
Difference compare(const Image8& reference, const Image8& test);

}  // namespace peelray
