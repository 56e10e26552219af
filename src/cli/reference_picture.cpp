#include "cli/reference_picture.h"

#include <fmt/format.h>

#include <chrono>
#include <thread>

#include "cli/stats.h"
#include "reference/path_tracer.h"

namespace peelray {

MadePicture reference_picture(PreparedScene& scene, const PictureSettings& settings,
                              const std::function<void(double)>& progress) {
    using Clock = std::chrono::steady_clock;
    const auto ms = [](Clock::duration time) { return std::chrono::duration<double, std::milli>(time).count(); };
    const auto start = Clock::now();
    const PathTracer tracer(scene.scene, scene.geometry(), scene.environment);
    const auto built = Clock::now();
    MadePicture made;
    made.picture = tracer.render(settings, progress);
    const auto done = Clock::now();

    const double build_ms = ms(built - start), trace_ms = ms(done - built);
    made.device = fmt::format("{} CPU threads", std::max(1u, std::thread::hardware_concurrency()));
    made.stats = {{"tracer", "reference"},
                  {"device", made.device},
                  {"kind", "cpu"},
                  {"driver", PathTracer::version()},
                  {"api_version", nullptr},
                  {"commit", build_commit()},
                  {"image", {made.picture.width, made.picture.height}},
                  {"triangles", scene.triangles},
                  {"timed", true},
                  {"frame_ms", trace_ms},
                  {"build_ms", build_ms}};
    made.stats["passes"] = {{{"name", "build/bvh"}, {"ms", build_ms}}, {{"name", "trace and shade"}, {"ms", trace_ms}}};
    made.stats["rays"] = ray_stats(made.picture.rays);
    made.stats["hit"] = "double";
    made.summary = fmt::format("; BVH {:.2f} s, rays {:.2f} s", build_ms * 1e-3, trace_ms * 1e-3);
    return made;
}

std::string reference_version() {
    return "reference, " + PathTracer::version();
}

}  // namespace peelray
