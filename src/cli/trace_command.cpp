// `peelray trace`.
#include <algorithm>

#include "base/error.h"
#include "base/progress.h"
#include "cli/prepare.h"
#include "cli/stats.h"
#include "image/image.h"
#include "image/npy.h"

namespace peelray {

namespace {

/// What a run of `peelray trace` found out.
struct Traced {
    std::vector<HitRecord> hits;
    double trace_ms = 0;  ///< median over the repetitions
    double build_ms = 0;
    std::vector<PassTime> build_passes;
    size_t found = 0;
};

/// Traces all rays in batches, so that any number of them fits.
Traced trace_rays(Device& device, const Geometry& geometry, const std::vector<RayRecord>& rays,
                  const AutoChoice& choice, const TraceArguments& a, ComputeBuilder& builder, Cube& cube) {
    static_assert(sizeof(RayRecord) == sizeof(Ray) && sizeof(HitRecord) == sizeof(Hit));
    Traced result;
    TriangleBuffers triangles(device, geometry.positions, geometry.triangles, geometry.lower, geometry.upper);
    Commands commands(device);
    builder.build(commands, triangles, cube, choice.ldc, sampling_for(choice.hit));
    result.build_passes = commands.times();
    result.build_ms = commands.elapsed_ms();

    const size_t batch = std::min<size_t>(std::max<size_t>(rays.size(), 1), 2u << 20);
    Buffer ray_buffer(device, "rays", batch * sizeof(Ray)), hit_buffer(device, "hits", batch * sizeof(Hit));
    result.hits.resize(rays.size());
    std::vector<double> times(a.repeat, 0.0);
    Progress progress("tracing", double(rays.size()));
    for (size_t first = 0; first < rays.size(); first += batch) {
        const size_t count = std::min(batch, rays.size() - first);
        commands.upload(ray_buffer, std::span<const RayRecord>(&rays[first], count));
        const uint32_t warm_up = a.repeat > 1 ? 1 : 0;
        for (uint32_t i = 0; i < a.repeat + warm_up; i++) {
            record_trace(commands, device, cube, triangles, {ray_buffer, nullptr, uint32_t(count)}, hit_buffer,
                         choice.hit, a.any_hit);
            commands.submit();
            if (i >= warm_up) times[i - warm_up] += commands.elapsed_ms();
        }
        const auto part = commands.download<HitRecord>(hit_buffer, count);
        std::copy(part.begin(), part.end(), result.hits.begin() + ptrdiff_t(first));
        progress.update(double(first + count));
    }
    std::nth_element(times.begin(), times.begin() + ptrdiff_t(times.size() / 2), times.end());
    result.trace_ms = times[times.size() / 2];
    for (HitRecord& hit : result.hits) {
        if (hit.triangle != ~0u)
            result.found++;
        else
            hit.u = hit.v = 0;  // a miss carries no weights
    }
    return result;
}

nlohmann::ordered_json trace_stats(const Device& device, const Geometry& geometry, const Traced& traced,
                                   const AutoChoice& choice, bool any_hit, const Cube& cube,
                                   const ComputeBuilder& builder) {
    nlohmann::ordered_json json = device_stats(device);
    json["triangles"] = geometry.triangles.size();
    json["rays"] = traced.hits.size();
    json["hits"] = traced.found;
    json["hit"] = choice.hit == HitTest::exact ? "exact" : "planar";
    json["any_hit"] = any_hit;
    json["build_ms"] = traced.build_ms;
    for (const PassTime& time : traced.build_passes) json["passes"].push_back({{"name", time.name}, {"ms", time.ms}});
    json["passes"].push_back({{"name", "trace"}, {"ms", traced.trace_ms}});
    json["trace_ms"] = traced.trace_ms;
    json["mrays_per_second"] = nullptr;
    if (traced.trace_ms > 0) json["mrays_per_second"] = double(traced.hits.size()) / traced.trace_ms * 1e-3;
    json["ldc"] = cube_stats(cube.grid, cube.counts, choice.ldc, cube.bytes().total(), builder.scratch_bytes(),
                             choice.hit == HitTest::exact ? "conservative" : "centre");
    return json;
}

}  // namespace

void run_trace(const TraceArguments& a) {
    a.tracing.check();
    if (a.tracing.tracer != "ldc") fail("--tracer {} traces no rays from files: use --tracer ldc", a.tracing.tracer);
    check_repeat(a.repeat);
    std::vector<std::filesystem::path> outputs = {a.hits};
    if (!a.stats.empty()) outputs.push_back(a.stats);
    check_outputs(outputs, {a.scene, a.rays});
    const std::vector<RayRecord> rays = read_rays(a.rays);
    const Scene scene = load_scene(a.scene);
    const Geometry geometry = visible_geometry(scene);

    RenderSettings settings;
    settings.ldc = a.tracing.ldc.value_or(0);
    choose_hit(settings, a.tracing.hit);
    const AutoChoice choice = choose_automatically(uint32_t(geometry.triangles.size()), settings);

    Device device({a.device.device, a.device.validate});
    ComputeBuilder builder(device);
    Cube cube;
    const Traced traced = trace_rays(device, geometry, rays, choice, a, builder, cube);
    device.check_validation();
    write_hits(a.hits, traced.hits);
    if (!a.stats.empty()) write_json(a.stats, trace_stats(device, geometry, traced, choice, a.any_hit, cube, builder));

    fmt::print("{}: {} rays, {} hits ({}), cube {}", a.hits.string(), rays.size(), traced.found,
               choice.hit == HitTest::exact ? "exact" : "planar", choice.ldc);
    if (device.timestamp_period() > 0)
        fmt::print("; on the GPU: cube {:.2f} ms, rays {:.2f} ms", traced.build_ms, traced.trace_ms);
    fmt::print("; {}\n", device.info().name);
}

}  // namespace peelray
