#include "workspace/cpu_pictures.h"

#include "base/error.h"

#ifdef PEELRAY_WITH_REFERENCE
#include <algorithm>
#include <chrono>
#include <thread>

#include "assembly/emitters.h"
#include "base/text.h"
#include "reference/past_pictures.h"
#include "reference/path_tracer.h"

namespace peelray {

/// Triangles to look for light on. Dividing the scene up takes time: only where something emits.
static Emitters emitters_in(const PosedScene& posed, const PictureSettings& settings) {
    const Scene& scene = posed.scene();
    return std::ranges::any_of(scene.materials, is_emissive) && samples_emitters(settings)
               ? emitters_of(scene, posed.assembly())
               : Emitters{};
}

namespace {

struct KeptPast : CpuPast {
    PastPictures pictures;
};

}  // namespace

std::unique_ptr<CpuPast> make_cpu_past() {
    return std::make_unique<KeptPast>();
}

double cpu_warm_up(PosedScene& scene, const RenderSettings& settings, const PictureWatch& watch, CpuPast& past) {
    const RenderStats times = cpu_picture(scene, settings, watch, &past).stats.render;
    return times.build_ms + times.frame_ms;
}

MadePicture cpu_picture(PosedScene& scene, const RenderSettings& settings, const PictureWatch& watch, CpuPast* past) {
    using Clock = std::chrono::steady_clock;
    const auto ms = [](Clock::duration time) { return std::chrono::duration<double, std::milli>(time).count(); };
    const auto start = Clock::now();
    const Geometry& geometry = scene.geometry();
    const PathTracer tracer(scene.scene(), scene.moment(), geometry, scene.environment(), emitters_in(scene, settings),
                            settings.tracer == Tracer::cpu ? Precision::single_ : Precision::double_);
    const auto built = Clock::now();
    MadePicture made;
    made.picture = tracer.render(settings, watch, 0, past ? &static_cast<KeptPast*>(past)->pictures : nullptr);
    const auto done = Clock::now();

    const std::string threads = counted("{} CPU thread{|s}", std::max(1u, std::thread::hardware_concurrency()));
    made.stats = picture_stats({threads, "cpu", PathTracer::version(), ""}, scene, made.picture);
    RenderStats& times = made.stats.render;
    times.tracer = settings.tracer;
    times.timed = true;
    times.build_ms = ms(built - start);
    times.frame_ms = ms(done - built);
    times.passes = {{"build/bvh", times.build_ms}, {"trace and shade", times.frame_ms}};
    return made;
}

std::string cpu_version(Tracer tracer) {
    return fmt::format("{}, {}", name_of(tracer), PathTracer::version());
}

}  // namespace peelray
#else
namespace peelray {

[[noreturn]] static void fail_without(Tracer tracer) {
    fail("this program was built without its CPU side (PEELRAY_REFERENCE=OFF), so without {} {}: use {} ldc",
         setting::tracer, name_of(tracer), setting::tracer);
}

std::unique_ptr<CpuPast> make_cpu_past() {
    fail_without(Tracer::cpu);
}

MadePicture cpu_picture(PosedScene&, const RenderSettings& settings, const PictureWatch&, CpuPast*) {
    fail_without(settings.tracer);
}

double cpu_warm_up(PosedScene&, const RenderSettings& settings, const PictureWatch&, CpuPast&) {
    fail_without(settings.tracer);
}

std::string cpu_version(Tracer tracer) {
    fail_without(tracer);
}

}  // namespace peelray
#endif
