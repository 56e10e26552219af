// `peelray trace`.
#include <algorithm>

#include "base/error.h"
#include "base/progress.h"
#include "base/text.h"
#include "cli/commands.h"
#include "cli/messages.h"
#include "cli/outputs.h"
#include "cli/stats_json.h"
#include "common/ray.h"
#include "image/image.h"
#include "image/npy.h"
#include "loaders/load.h"
#include "render/ray_scene.h"
#include "workspace/posed_scene.h"
#include "workspace/render_settings.h"

namespace peelray {

namespace {

/// What a run of `peelray trace` found out.
struct Traced {
    std::vector<HitRecord> hits;
    bool counted = false;
    std::vector<RayCosts> costs;  ///< of each ray, if counted
    AllKindCosts sums;
    double trace_ms = 0;  ///< median over the repetitions
    size_t found = 0;
};

/// Traces all rays in batches, so that any number of them fits.
Traced trace_rays(Device& device, RayScene& scene, const std::vector<RayRecord>& rays, const TraceArguments& a) {
    static_assert(sizeof(RayRecord) == sizeof(Ray) && sizeof(HitRecord) == sizeof(FileHit));
    Traced result;
    const MemoryPart part(device, "rays");
    Commands commands(device);
    const size_t most = std::min<size_t>(2u << 20, device.limits().maxStorageBufferRange / sizeof(Ray));
    const size_t batch = std::min(std::max<size_t>(rays.size(), 1), most);
    Buffer ray_buffer(device, "rays", batch * sizeof(Ray)), hit_buffer(device, "hits", batch * sizeof(FileHit));
    // What is counted is counted in every repetition, and of the last one it stays.
    const bool counts = result.counted = !a.counters.empty();
    Buffer cost_buffer;
    const CostTotals totals(device);
    if (counts) cost_buffer = Buffer(device, "costs", batch * sizeof(RayCosts));
    const CountBuffers counting{cost_buffer, totals.buffer()};
    result.hits.resize(rays.size());
    result.costs.resize(counts ? rays.size() : 0);
    std::vector<double> times(a.repeat, 0.0);
    Progress progress("tracing", double(rays.size()));
    for (size_t first = 0; first < rays.size(); first += batch) {
        const size_t count = std::min(batch, rays.size() - first);
        commands.upload(ray_buffer, std::span<const RayRecord>(&rays[first], count));
        const uint32_t warm_up = a.repeat > 1 ? 1 : 0;
        for (uint32_t i = 0; i < a.repeat + warm_up; i++) {
            if (counts) {
                commands.fill(cost_buffer, 0);
                totals.record_clear(commands);
            }
            scene.record(commands, ray_buffer, uint32_t(count), hit_buffer, a.any_hit, counts ? &counting : nullptr);
            if (counts) totals.record_readback(commands);
            commands.submit();
            for (const PassTime& time : commands.times())
                if (i >= warm_up && time.name.starts_with("trace")) times[i - warm_up] += time.ms;
        }
        const auto part = commands.download<HitRecord>(hit_buffer, count);
        std::copy(part.begin(), part.end(), result.hits.begin() + ptrdiff_t(first));
        if (counts) {
            totals.add_to(result.sums);
            const auto costs = commands.download<RayCosts>(cost_buffer, count);
            std::copy(costs.begin(), costs.end(), result.costs.begin() + ptrdiff_t(first));
        }
        progress.update(double(first + count));
    }
    std::nth_element(times.begin(), times.begin() + ptrdiff_t(times.size() / 2), times.end());
    result.trace_ms = times[times.size() / 2];
    for (const HitRecord& hit : result.hits) result.found += hit.triangle != ~0u;
    return result;
}

/// Rays of the world in the coordinates of the scene.
std::vector<RayRecord> in_scene(std::vector<RayRecord> rays, const glm::dvec3& origin) {
    if (origin == glm::dvec3(0)) return rays;
    for (RayRecord& ray : rays) {
        ray.ox = float(ray.ox - origin.x);
        ray.oy = float(ray.oy - origin.y);
        ray.oz = float(ray.oz - origin.z);
    }
    return rays;
}

TraceStats trace_stats(Device& device, const Geometry& geometry, Tracer tracer, const TracerStats& traced_in,
                       const FrameMeter& build, const Traced& traced, bool any_hit) {
    TraceStats stats;
    stats.machine = machine_of(device);
    stats.triangles = geometry.triangles.size();
    stats.rays = traced.hits.size();
    stats.hits = traced.found;
    stats.any_hit = any_hit;
    stats.build_ms = build.ms;
    stats.build_passes = build.passes.rows();
    stats.trace_ms = traced.trace_ms;
    if (traced.counted) stats.costs = traced.sums;
    if (tracer == Tracer::khr) {
        stats.structures = traced_in.structures;
        return stats;
    }
    stats.cubes = traced_in.cubes;
    stats.choice = traced_in.cubes.choice;
    stats.bodies = traced_in.bodies;
    stats.shown = traced_in.shown;
    stats.box = {geometry.lower, geometry.upper};
    stats.memory = device.allocations();
    stats.peak_memory = device.peak_allocations();
    return stats;
}

}  // namespace

void run_trace(const TraceArguments& a) {
    check(a.tracing);
    const Tracer tracer = a.tracing.tracer.value_or(Tracer::ldc);
    if (tracer != Tracer::ldc && tracer != Tracer::khr)
        fail("--tracer {} traces no rays from files: use --tracer ldc or khr", name_of(tracer));
    std::vector<std::filesystem::path> outputs = {a.hits};
    for (const auto& more : {a.stats, a.counters})
        if (!more.empty()) outputs.push_back(more);
    check_outputs(outputs, {a.scene, a.rays});
    std::vector<RayRecord> rays = read_rays(a.rays);
    Scene scene = load_scene(a.scene, {a.variant, a.point_size.value_or(0), a.double_sided});
    rays = in_scene(std::move(rays), scene.origin);
    const Moment rest = at_rest(scene);
    const Geometry geometry = flatten(scene, rest);
    check_visible(geometry, scene, false, print_note);

    RenderSettings settings;
    choose_tracing(settings, a.tracing);
    choose_hit(settings, a.tracing.hit);
    settings.tracer = tracer;
    settings.structures = StructureUpdate::keep;

    Device device(device_options(a.device));
    settings.cubes = choose_automatically(uint32_t(geometry.triangles.size()), settings);
    RayScene traced_scene = [&] {
        const MemoryPart part(device, "scene");
        return RayScene(device, scene, rest, assemble(scene, rest, motion_of(scene, "")), settings);
    }();
    const Traced traced = trace_rays(device, traced_scene, rays, a);
    device.check_validation();
    Commands commands(device);
    const TracerStats traced_in = traced_scene.stats(commands);
    const bool by_khr = settings.tracer == Tracer::khr;
    if (!by_khr) {
        for (const std::string& note :
             {room_note(traced_in.cubes), tolerance_note(traced_in.bodies, traced_in.cubes.choice)})
            if (!note.empty()) print_note(note);
    }
    write_hits(a.hits, traced.hits);
    if (!a.counters.empty()) write_costs(a.counters, traced.costs);
    if (!a.stats.empty()) {
        TraceStats stats =
            trace_stats(device, geometry, settings.tracer, traced_in, traced_scene.build(), traced, a.any_hit);
        stats.origin = scene.origin;
        write_json(a.stats, trace_json(stats));
    }

    fmt::print("{}: {}, {}", a.hits.string(), counted("{} ray{|s}", rays.size()), counted("{} hit{|s}", traced.found));
    if (by_khr)
        fmt::print(", {}", counted("{} acceleration structure{|s}", traced_in.structures.bodies));
    else
        fmt::print(" ({}), {}", name_of(traced_in.cubes.choice.hit), count_of_cubes(traced_in.cubes));
    if (device.timestamp_period() > 0)
        fmt::print("; on the GPU: {} {:.2f} ms, rays {:.2f} ms", by_khr ? "structures" : "cubes",
                   traced_scene.build().ms, traced.trace_ms);
    fmt::print("; {}\n", device.info().name);
}

}  // namespace peelray
