#include "reference/path_tracer.h"

#include <embree3/rtcore.h>

#include "base/error.h"
#include "reference/picture_tracer.h"
#include "settings/limits.h"

namespace peelray {

namespace in_single {
std::unique_ptr<PathTracer::Impl> make_picture_tracer(const Scene& scene, const Moment& moment,
                                                      const Geometry& geometry, const Environment& environment,
                                                      std::span<const Emitter> emitters);
}

static void check_settings(const PictureSettings& s) {
    if (s.width < 1 || s.height < 1 || s.width > 65536 || s.height > 65536)
        fail("a picture of {}x{} pixels is impossible: choose 1x1 to 65536x65536 ({})", s.width, s.height,
             setting::size);
    check_limits(kBounceLimits, setting::bounces, s.bounces);
    check_limits(kBounceLimits, setting::gi, s.gi);
    check_limits(kPhotonLimits, setting::caustics, s.caustics);
    check_limits(kSampleLimits, setting::spp, s.spp);
}

PathTracer::PathTracer(const Scene& scene, const Moment& moment, const Geometry& geometry,
                       const Environment& environment, std::span<const Emitter> emitters, Precision precision)
    : impl_((precision == Precision::single_ ? in_single::make_picture_tracer : in_double::make_picture_tracer)(
          scene, moment, geometry, environment, emitters)) {}

PathTracer::~PathTracer() = default;

Picture PathTracer::render(const PictureSettings& settings, const PictureWatch& watch, unsigned threads,
                           PastPictures* past) const {
    check_settings(settings);
    return impl_->render(settings, watch, threads, past);
}

std::string PathTracer::version() {
    return "Embree " RTC_VERSION_STRING;
}

}  // namespace peelray
