// What the denoiser keeps of the pictures of the moments before (Denoise::temporal), and how it looks at them.
#pragma once

#include <array>
#include <optional>

#include "denoise/denoise_params.h"
#include "gpu/commands.h"
#include "scene/picture.h"

namespace peelray {

struct FrameState;

/// Pictures by PictureSettings::number, the last DENOISE_WARM_UP + 1 of them. All are of one size and made with the
/// same settings; whoever renders sees to that, and that a picture's predecessors are rendered before it.
class PastFrames {
  public:
    explicit PastFrames(Device& device) : device_(device) {}

    /// Makes room; forgets pictures of another size.
    void prepare(const PictureSettings& settings);
    /// Records where what a level's ways meet was before: of sample 0, and before that level's guides. `links`: where
    /// the ways have come to. FrameState::before must know the moment before.
    void record_motion(FrameState& f, uint32_t level, uint32_t first_row, const Buffer& links);
    /// Records that the picture `settings.number` is kept. `features`, `signal`: as denoise_prepare leaves them.
    void record_memory(Commands& commands, const PictureSettings& settings, const Buffer& features,
                       const Buffer& signal);
    /// Records the mean over that picture, which is kept already, and those before it, as far as each of its surfaces
    /// can be followed: light as in `signal`, and its variance.
    void record_mean(Commands& commands, const PictureSettings& settings, const Buffer& features, const Buffer& signal,
                     const Buffer& mean);

    /// DenoiseMotion of each pixel of the picture that is being made, row by row.
    const Buffer& motions() const { return motions_; }
    uint64_t bytes() const;

  private:
    struct Kept {
        std::optional<int64_t> number;
        Buffer past, light, motion;  ///< uvec4 (denoise/past.glsl), vec4 and vec3 of each pixel
    };
    Kept& kept(int64_t number);

    Device& device_;
    glm::uvec2 size_{0};
    std::array<Kept, DENOISE_WARM_UP + 1> kept_;
    Buffer motions_;  ///< DenoiseMotion of each pixel, of the picture that is being made
    Buffer images_;   ///< DenoiseImage of each pixel of a band
    Buffer trails_;   ///< DenoiseTrail of each pixel
};

}  // namespace peelray
