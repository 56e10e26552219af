// Pictures in one precision. Private to src/reference.
#pragma once

#include "reference/path_tracer.h"
#include "reference/real.h"

namespace peelray {

struct PathTracer::Impl {
    virtual ~Impl() = default;
    virtual Picture render(const PictureSettings& settings, const PictureWatch& watch, unsigned threads,
                           PastPictures* past) const = 0;
};

inline namespace PRECISION {

std::unique_ptr<PathTracer::Impl> make_picture_tracer(const Scene& scene, const Moment& moment,
                                                      const Geometry& geometry, const Environment& environment,
                                                      std::span<const Emitter> emitters);

}
}  // namespace peelray
