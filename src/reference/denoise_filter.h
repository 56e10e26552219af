// A picture in the denoiser. Private to src/reference.
#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "denoise/denoise_params.h"

namespace peelray {

class DenoiseFilter {
  public:
    /// What a pixel shows.
    struct Features {
        bool filtered = false;
        glm::dvec3 normal{0};
        double depth = 0;
        glm::dvec2 slope{0};  ///< of the depth, to the right and down
        double gloss = 0, albedo = 0;
    };
    /// Light over albedo, and the variance of its luminance; below 0: not known, and less how many pictures it is the
    /// mean of.
    struct Signal {
        glm::dvec3 light{0};
        double variance = -1;
    };

    DenoiseFilter(uint32_t width, uint32_t height, std::span<const DenoiseGuide> guides);

    int width() const { return width_; }
    int height() const { return height_; }
    bool inside(int x, int y) const { return x >= 0 && y >= 0 && x < width_ && y < height_; }
    size_t index(int x, int y) const { return size_t(y) * size_t(width_) + size_t(x); }
    const Features& features(int x, int y) const { return features_[index(x, y)]; }
    const Signal& signal(int x, int y) const { return signal_[index(x, y)]; }

    /// body(x, y) for all pixels, on all cores.
    void for_all(const std::function<void(int, int)>& body) const;
    /// body(weight, x, y) for what is like the pixel around it, itself included.
    template <typename Body>
    void for_alike(int x, int y, int reach, Body body) const {
        const Features& pixel = features(x, y);
        for (int dy = -reach; dy <= reach; dy++)
            for (int dx = -reach; dx <= reach; dx++)
                if (const double weight = likeness(pixel, x, y, dx, dy); weight > 0) body(weight, x + dx, y + dy);
    }

    /// The steps, in their order. Instead of the picture's own light, that of several.
    void take(std::vector<Signal> mean) { signal_ = std::move(mean); }
    void limit_outliers();
    void estimate_variance(bool one_sample, bool of_several);
    void iterate(int step);
    void apply(std::span<glm::dvec4> sums) const;

  private:
    void replace(const std::function<Signal(int, int)>& made);
    void prepare(int x, int y);
    double depth(int x, int y) const;
    double slope(int x, int y, int dx, int dy) const;
    double likeness(const Features& pixel, int x, int y, int dx, int dy) const;
    Signal within_limits(int x, int y) const;
    double variance_of_samples(int x, int y) const;
    double variance_of_neighbours(int x, int y, const std::vector<Signal>& light) const;
    double smooth_variance(int x, int y) const;
    Signal filtered(int x, int y, int step) const;

    int width_, height_;
    std::span<const DenoiseGuide> guides_;
    std::vector<Features> features_;
    std::vector<Signal> signal_, first_;
};

}  // namespace peelray
