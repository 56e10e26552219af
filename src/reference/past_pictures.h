// What the denoiser keeps of the pictures of the moments before (Denoise::temporal): what src/render/past_frames.h
// does, written apart from it.
#pragma once

#include <glm/glm.hpp>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "denoise/denoise_params.h"
#include "reference/denoise_filter.h"

namespace peelray {

class PastPictures {
  public:
    /// Keeps the picture `number`, in the place of one whose number differs by DENOISE_WARM_UP + 1 or a multiple.
    /// `guides`, `motions`: of width·height pixels, row by row.
    void keep(int64_t number, uint32_t width, uint32_t height, std::span<const DenoiseGuide> guides,
              std::span<const DenoiseMotion> motions);
    /// The mean of the picture `number` with those before it that are kept, as far back as each surface can be
    /// followed; the variance of that mean, or below 0: it is not known, and less how many pictures there are.
    /// `filter`: holds that picture.
    std::vector<DenoiseFilter::Signal> mean(const DenoiseFilter& filter, int64_t number) const;

  private:
    struct Pixel {
        DenoiseFilter::Features features;
        DenoiseFilter::Signal signal;
        DenoiseMotion motion{};
        double around = 0, deviation = 0;  ///< the mean light of what is alike around, and of that the deviation
    };
    using Kept = std::vector<Pixel>;  ///< row by row
    struct Trail;
    struct Seen;
    static bool is_same(const Pixel& present, const Trail& trail, const Pixel& pixel);
    static std::optional<Seen> look(const DenoiseFilter& filter, const Kept& then, const Pixel& present,
                                    const Trail& trail);
    DenoiseFilter::Signal mean_at(const DenoiseFilter& filter, int64_t number, int x, int y) const;

    std::map<int64_t, Kept> kept_;
};

}  // namespace peelray
