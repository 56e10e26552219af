// The frame of docs/frame.md on the CPU: in double precision, where it is ground truth, or in single, where it is fast.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "scene/emitters.h"
#include "scene/environment.h"
#include "scene/moment.h"
#include "scene/passes.h"

namespace peelray {

class PastPictures;

/// `double_`: hits are the oracle's (Embree 3 finds candidates, double precision decides), and all shading is in double
/// precision. `single_`: hits are Embree's own, and all is in single precision.
enum class Precision { double_, single_ };

/// Renders what the GPU renders, by the same rules from the same samples, on all cores: the same camera rays, branches,
/// random numbers, lights and materials. So a picture differs from the GPU's where intersections do, and by rounding.
class PathTracer {
  public:
    /// `scene`, `geometry` and `environment` must outlive it. `emitters`: that are looked for as lamps are, by
    /// Emitter::id. Throws Error if Embree runs out of memory.
    PathTracer(const Scene& scene, const Moment& moment, const Geometry& geometry, const Environment& environment,
               std::span<const Emitter> emitters = {}, Precision precision = Precision::double_);
    ~PathTracer();

    /// `threads`: 0 for all cores. The picture does not depend on it. Progress receives the share done from the calling
    /// thread only, as all of `watch` is called; if it throws, all threads stop and the exception goes on.
    /// EnvironmentMode::sampled needs Environment::distribution. Throws Error for impossible settings, naming the
    /// option. With Denoise::temporal the picture is kept in `past` and those before it are looked for there; null: it
    /// has none.
    Picture render(const PictureSettings& settings, const PictureWatch& watch = {}, unsigned threads = 0,
                   PastPictures* past = nullptr) const;

    /// "Embree 3.13.5"
    static std::string version();

    struct Impl;

  private:
    std::unique_ptr<Impl> impl_;
};

}  // namespace peelray
