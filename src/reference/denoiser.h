// The denoiser on the CPU, in double precision: what src/render/denoiser.h does, written apart from it, so that each
// checks the other.
#pragma once

#include <glm/glm.hpp>
#include <span>

#include "denoise/denoise_params.h"
#include "reference/past_pictures.h"

namespace peelray {

/// Smooths the random part of a picture's light where it shows the same. `guides` and `sums`, over the samples, are of
/// width·height pixels, row by row; `one_sample`: there is but one a pixel. Uses all cores; the result does not depend
/// on how many there are.
void denoise(uint32_t width, uint32_t height, bool one_sample, std::span<const DenoiseGuide> guides,
             std::span<glm::dvec4> sums);

/// The same after taking the mean of the picture `number`, which is kept in `past`, and those before it.
void denoise(uint32_t width, uint32_t height, std::span<const DenoiseGuide> guides, int64_t number,
             const PastPictures& past, std::span<glm::dvec4> sums);

}  // namespace peelray
