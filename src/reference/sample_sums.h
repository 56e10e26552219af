// What the samples of a picture's pixels add up to, in double precision.
#pragma once

#include <vector>

#include "denoise/denoise_params.h"
#include "reference/past_pictures.h"
#include "scene/picture.h"

namespace peelray {

/// Pixels are independent of each other: threads may add to different ones at the same time.
class SampleSums {
  public:
    /// `settings` must outlive it; `has_unlit`: some material of the scene is. `past`: see PathTracer::render().
    SampleSums(const PictureSettings& settings, bool has_unlit, PastPictures* past);

    /// The next sample of a pixel, numbered row by row, which must be the sample `index` of it. What is negative or not
    /// finite counts as black, and PictureSettings::clamp holds. `radiance`: with alpha; `unlit`: of it, what a display
    /// shows as it is.
    void add(size_t pixel, uint32_t index, const glm::dvec4& radiance, const glm::dvec3& unlit);
    /// What guides the denoiser in a sample (Shader::guide, Shader::guide_motion).
    void add_guide(size_t pixel, uint32_t index, DenoiseGuide guide, const DenoiseMotion& motion);
    /// Sets size, radiance, encoded picture and Aovs of SAMPLE_AOVS of a picture whose pixels have `samples` samples;
    /// of a `finished` one after denoising it, if the settings say so.
    void store(Picture& picture, uint32_t samples, bool finished) const;
    /// With PictureSettings::moments: noise_of() these samples.
    float noise(uint32_t samples) const;

  private:
    void denoise_pixels(uint32_t samples, std::vector<glm::dvec4>& pixels) const;
    struct Moments {
        double mean = 0, deviations = 0;  ///< of the luminances; the latter: squared, their sum
    };
    const PictureSettings& settings_;
    std::vector<glm::dvec4> sums_;
    std::vector<glm::dvec3> unlit_;       ///< empty: no unlit material
    std::vector<DenoiseGuide> guides_;    ///< empty: nothing is denoised
    std::vector<DenoiseMotion> motions_;  ///< of sample 0; empty: not with others
    PastPictures* past_;
    std::vector<Moments> moments_;  ///< empty: not asked for
};

}  // namespace peelray
