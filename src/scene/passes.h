// The samples of a picture, pass after pass over all of it: how many come next, when it ends, and why. Whoever makes
// pictures goes by it, so that all end by the same rules.
#pragma once

#include <chrono>
#include <concepts>
#include <functional>
#include <span>

#include "scene/picture.h"

namespace peelray {

/// Who looks on while a picture is made.
struct PictureWatch {
    PictureWatch() = default;
    /// Only the share done is of interest.
    template <std::invocable<double> Progress>
    PictureWatch(Progress progress) : progress(std::move(progress)) {}

    /// Told the share done, [0, 1]; what it throws ends the work.
    std::function<void(double share)> progress;
    /// Asked after each pass: true: the picture ends with the samples that it has.
    std::function<bool()> stop;
    /// Called after each pass but the last; `look` makes the picture so far, without auxiliary pictures and before post
    /// passes, which takes time.
    std::function<void(const std::function<Picture()>& look)> pass_ended;
};

class Passes {
  public:
    /// Both must outlive it. Throws Error, naming the option, for limits that are impossible.
    Passes(const PictureSettings& settings, const PictureWatch& watch);

    /// False: there is one pass of all samples, and nobody looks on.
    bool are_several() const { return several_; }
    /// Samples of each pixel in the pass that begins now; 0: the picture is done. One at first; then as many as take a
    /// quarter of a second, that progress, limits and interrupts are not kept waiting.
    uint32_t next();
    /// The pass is whole. `noise`: estimates the picture's (noise_of), with PictureSettings::moments; it and `look` are
    /// called where they are needed only.
    void finish(const std::function<float()>& noise, const std::function<Picture()>& look);
    /// Of the picture, where a share of the running pass is done.
    double share(double of_pass) const;

    uint32_t done() const { return made_.count; }  ///< samples of the passes that are whole
    uint32_t end_of_pass() const { return made_.count + running_; }
    const SamplesMade& made() const { return made_; }

  private:
    using Clock = std::chrono::steady_clock;
    double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }
    bool ends();

    const PictureSettings& settings_;
    const PictureWatch& watch_;
    bool several_;
    Clock::time_point start_{}, pass_start_{};  ///< of the first pass and of the one that runs
    double busy_ = 0;                           ///< seconds that the passes took
    uint32_t running_ = 0;
    bool ended_ = false;
    SamplesMade made_;
};

/// Samples from which on PictureSettings::noise_target is looked at: fewer say too little of a variance.
inline constexpr uint32_t kLeastSamplesForNoise = 8;

/// How noisy a picture is: the 95th percentile, over `pixels` that see a surface, of the standard error of the mean
/// luminance over this luminance, to which a hundredth of the mean over all of them is added. 0 of no pixels, and where
/// all is black. Not by a mean, which few pixels that are far off would decide, and not by the worst.
struct PixelMoments {
    float mean, variance;  ///< of the luminances; the latter: of their mean
};
float noise_of(std::span<const PixelMoments> pixels);

}  // namespace peelray
