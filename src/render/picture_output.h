// The picture itself: samples are added up, post passes work on the sum, and it is encoded for a display.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "gpu/commands.h"
#include "render/denoiser.h"
#include "render/path_queues.h"
#include "scene/picture.h"

namespace peelray {

/// Records a pass between accumulation and tone mapping. It works on the finished picture in place: vec4 of each pixel,
/// row by row, the sum over the samples before exposure; alpha: how many of the samples met a surface. `settings`: spp
/// is the number of samples that the picture has.
using PostPass = std::function<void(Commands& commands, const Buffer& picture, const PictureSettings& settings)>;

class PictureOutput {
  public:
    explicit PictureOutput(Device& device) : device_(device) {}

    void add(PostPass pass) { post_passes_.push_back(std::move(pass)); }

    /// Makes room; `unlit`: some surfaces are to be shown as they are; `open`: nobody knows which sample is the last;
    /// `denoises`: what is drawn at random is smoothed in the end.
    void prepare(const PictureSettings& settings, bool unlit, bool open, bool denoises);
    /// Which wants guides from the frame; null: nothing is denoised.
    Denoiser* denoiser() { return denoiser_.get(); }
    /// Records that a band of the camera's level is added to the picture; `frame`: the view's constants. What no post
    /// pass waits for is encoded along with the last sample, where that is known.
    void record_accumulation(Commands& commands, const PathQueues& queues, const Buffer& frame, const LevelParams& p,
                             const PictureSettings& settings);
    /// Once all bands of a picture have been submitted that is made for later ones only: records what these need.
    void record_memory(Commands& commands, const PictureSettings& settings);
    /// Once all bands have been submitted: records the denoiser and the post passes, if there are any, and the
    /// encoding. False: nothing was left to do. From here on the `spp` of settings is the number of samples that the
    /// picture has.
    bool record_post(Commands& commands, const PictureSettings& settings);
    /// What the settings want. Vectors that are large enough already are filled as they are.
    void download(Commands& commands, const PictureSettings& settings, Picture& out);
    /// Picture::radiance, wanted or not.
    void download_radiance(Commands& commands, const PictureSettings& settings, Picture& out) const;
    /// Between two samples: the picture so far, before post passes. Submits.
    Picture look(Commands& commands, const PictureSettings& settings) const;
    /// With PictureSettings::moments: noise_of() the samples so far.
    float noise(Commands& commands, const PictureSettings& settings) const;

    /// With PictureSettings::moments: vec2 of each pixel, row by row: the mean of its samples' luminances (Rec. 709,
    /// before exposure) and the sum of their squared deviations from it. So that, divided by n(n - 1), is the variance
    /// of the mean of n samples.
    const Buffer& moments() const { return moments_; }

    uint64_t bytes() const {
        return picture_.bytes() + encoded_.bytes() + unlit_.bytes() + moments_.bytes() +
               (denoiser_ ? denoiser_->bytes() : 0);
    }

  private:
    void record_encoding(Commands& commands, const PictureSettings& settings, bool shares) const;
    double seen(Commands& commands, const PictureSettings& settings);
    void download_picture(Commands& commands, const PictureSettings& settings, Picture& out) const;

    Device& device_;
    std::vector<PostPass> post_passes_;
    std::unique_ptr<Denoiser> denoiser_;
    /// Gives the picture's values to the parts of a display: without what is unlit, nothing of `unlit_` is read.
    Binding unlit() const { return Binding::if_used("unlit", has_unlit_ ? &unlit_ : nullptr); }

    Buffer picture_, encoded_, seen_rows_;
    Buffer unlit_;    ///< vec3 of each pixel: what it sees of unlit surfaces; for post passes its share of the picture
    Buffer moments_;  ///< see moments()
    bool has_unlit_ = false, open_ = false;
};

}  // namespace peelray
