#include "workspace/reference.h"

#include "base/error.h"

#ifdef PEELRAY_WITH_REFERENCE
#include <algorithm>
#include <chrono>
#include <thread>

#include "assembly/emitters.h"
#include "base/text.h"
#include "reference/path_tracer.h"

namespace peelray {

/// Triangles to look for light on. Dividing the scene up takes time: only where something emits.
static Emitters emitters_in(const PosedScene& posed, const PictureSettings& settings) {
    const Scene& scene = posed.scene();
    return std::ranges::any_of(scene.materials, is_emissive) && samples_emitters(settings)
               ? emitters_of(scene, posed.assembly())
               : Emitters{};
}

MadePicture reference_picture(PosedScene& scene, const PictureSettings& settings, const PictureWatch& watch) {
    using Clock = std::chrono::steady_clock;
    const auto ms = [](Clock::duration time) { return std::chrono::duration<double, std::milli>(time).count(); };
    const auto start = Clock::now();
    const Geometry& geometry = scene.geometry();
    const PathTracer tracer(scene.scene(), scene.moment(), geometry, scene.environment(), emitters_in(scene, settings));
    const auto built = Clock::now();
    MadePicture made;
    made.picture = tracer.render(settings, watch);
    const auto done = Clock::now();

    const std::string threads = counted("{} CPU thread{|s}", std::max(1u, std::thread::hardware_concurrency()));
    made.stats = picture_stats({threads, "cpu", PathTracer::version(), ""}, scene, made.picture);
    RenderStats& times = made.stats.render;
    times.tracer = Tracer::reference;
    times.timed = true;
    times.build_ms = ms(built - start);
    times.frame_ms = ms(done - built);
    times.passes = {{"build/bvh", times.build_ms}, {"trace and shade", times.frame_ms}};
    return made;
}

std::string reference_version() {
    return "reference, " + PathTracer::version();
}

}  // namespace peelray
#else
namespace peelray {

[[noreturn]] static void fail_without_reference() {
    fail("this program was built without the reference (PEELRAY_REFERENCE=OFF): use {} ldc", setting::tracer);
}

MadePicture reference_picture(PosedScene&, const PictureSettings&, const PictureWatch&) {
    fail_without_reference();
}

std::string reference_version() {
    fail_without_reference();
}

}  // namespace peelray
#endif
