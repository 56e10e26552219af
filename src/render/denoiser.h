// The denoiser: light that was drawn at random is smoothed where the picture shows the same, in passes of its own.
#pragma once

#include <memory>

#include "denoise/denoise_params.h"
#include "gpu/commands.h"
#include "render/past_frames.h"
#include "scene/picture.h"

namespace peelray {

struct FrameState;

inline uint64_t pixels_of(const PictureSettings& settings) {
    return uint64_t(settings.width) * settings.height;
}

/// Workgroups of passes with denoise/tile.glsl.
inline Groups tiles_of(const PictureSettings& settings) {
    return groups_for(uint64_t((settings.width + 7) / 8) * ((settings.height + 7) / 8), 1);
}

/// An edge-avoiding à-trous wavelet filter (Dammertz et al. 2010) guided by normals, depths and the samples' variance
/// (SVGF, Schied et al. 2017), of one picture alone or, with Denoise::temporal, of its mean with those of the moments
/// before, which are rendered first. What is filtered is the random part of each pixel's light, divided
/// by the albedo: emission, the environment, images in mirrors and textures stay as they are.
class Denoiser {
  public:
    explicit Denoiser(Device& device) : device_(device) {}

    /// Makes room.
    void prepare(const PictureSettings& settings);
    /// After the shading of a band's sample: records what the picture is guided by. Like the picture itself it is left
    /// alone where a queue overflowed.
    void record_guides(FrameState& f, uint32_t sample, uint32_t first_row);
    /// Once all samples are there: records the filter, on a picture as PostPass has it.
    void record_filter(Commands& commands, const Buffer& picture, const PictureSettings& settings);
    /// Instead, of a picture that is made for later ones only.
    void record_memory(Commands& commands, const PictureSettings& settings);

    /// DenoiseGuide of each pixel, row by row.
    const Buffer& guides() const { return guides_; }
    uint64_t bytes() const;

  private:
    void record_level(FrameState& f, uint32_t level, uint32_t sample, uint32_t first_row);

    void record_preparation(Commands& commands, const PictureSettings& settings);

    Device& device_;
    std::unique_ptr<PastFrames> past_;  ///< null: pictures are filtered by themselves
    Buffer guides_, links_;
    Buffer features_;           ///< uvec4 of each pixel (denoise/features.glsl)
    Buffer first_, one_, two_;  ///< vec4 of each pixel: light over albedo, variance of its luminance
};

}  // namespace peelray
