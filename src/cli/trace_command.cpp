// `peelray trace`.
#include <algorithm>

#include "base/error.h"
#include "base/progress.h"
#include "cli/program.h"
#include "cli/stats.h"
#include "image/image.h"
#include "image/npy.h"

namespace peelray {

void run_trace(const TraceArguments& a) {
    a.tracing.check();
    check_repeat(a.repeat);
    std::vector<std::filesystem::path> outputs = {a.hits};
    if (!a.stats.empty()) outputs.push_back(a.stats);
    check_outputs(outputs, {a.scene, a.rays});
    const std::vector<RayRecord> rays = read_rays(a.rays);
    const Scene scene = load_scene(a.scene);
    const Geometry geometry = visible_geometry(scene);

    RenderSettings settings;
    settings.ldc = a.tracing.ldc.value_or(0);
    settings.hit_auto = a.tracing.hit == "auto";
    settings.hit = a.tracing.hit == "planar" ? HitTest::planar : HitTest::exact;
    const AutoChoice choice = choose_automatically(uint32_t(geometry.triangles.size()), settings);

    Device device({a.device.device, a.device.validate});
    TriangleBuffers triangles(device, geometry.positions, geometry.triangles, geometry.lower, geometry.upper);
    ComputeBuilder builder(device);
    Cube cube;
    Commands commands(device);
    builder.build(commands, triangles, cube, choice.ldc, sampling_for(choice.hit));
    const auto build_times = commands.times();
    const double build_ms = commands.elapsed_ms();

    // Rays go in batches, so that any number of them fits.
    static_assert(sizeof(RayRecord) == sizeof(Ray) && sizeof(HitRecord) == sizeof(Hit));
    const size_t batch = std::min<size_t>(std::max<size_t>(rays.size(), 1), 2u << 20);
    Buffer ray_buffer(device, "rays", batch * sizeof(Ray)), hit_buffer(device, "hits", batch * sizeof(Hit));
    std::vector<HitRecord> hits(rays.size());
    std::vector<double> times(std::max(a.repeat, 1u), 0.0);
    Progress progress("tracing", double(rays.size()));
    for (size_t first = 0; first < rays.size(); first += batch) {
        const size_t count = std::min(batch, rays.size() - first);
        commands.upload(ray_buffer, std::span<const RayRecord>(&rays[first], count));
        for (uint32_t i = 0; i < a.repeat + (a.repeat > 1 ? 1 : 0); i++) {
            record_trace(commands, device, cube, triangles, {ray_buffer, nullptr, uint32_t(count)}, hit_buffer, choice.hit, a.any_hit);
            commands.submit();
            // With repetitions the first one warms up.
            if (a.repeat > 1 && i == 0) continue;
            times[a.repeat > 1 ? i - 1 : 0] += commands.elapsed_ms();
        }
        const auto part = commands.download<HitRecord>(hit_buffer, count);
        std::copy(part.begin(), part.end(), hits.begin() + ptrdiff_t(first));
        progress.update(double(first + count));
    }
    // A miss carries no barycentric weights; planar hits know none of their own.
    for (size_t i = 0; i < hits.size(); i++)
        if (hits[i].triangle == ~0u) hits[i].u = hits[i].v = 0;
    if (choice.hit == HitTest::planar) {
        for (size_t i = 0; i < hits.size(); i++) {
            if (hits[i].triangle == ~0u) continue;
            const glm::uvec3 corners = geometry.triangles[hits[i].triangle];
            const glm::dvec3 p0 = geometry.positions[corners.x], e = glm::dvec3(geometry.positions[corners.y]) - p0,
                             f = glm::dvec3(geometry.positions[corners.z]) - p0;
            const glm::dvec3 p = glm::dvec3(rays[i].ox, rays[i].oy, rays[i].oz) + double(hits[i].t) * glm::dvec3(rays[i].dx, rays[i].dy, rays[i].dz) - p0;
            const glm::dvec3 n = glm::cross(e, f);
            const double scale = 1 / glm::dot(n, n);
            glm::dvec2 uv(glm::dot(glm::cross(p, f), n) * scale, glm::dot(glm::cross(e, p), n) * scale);
            uv = glm::clamp(uv, 0.0, 1.0);
            uv /= std::max(1.0, uv.x + uv.y);
            hits[i].u = float(uv.x);
            hits[i].v = float(uv.y);
        }
    }
    device.check_validation();
    write_hits(a.hits, hits);

    std::nth_element(times.begin(), times.begin() + ptrdiff_t(times.size() / 2), times.end());
    const double trace_ms = times[times.size() / 2];
    const size_t found = size_t(std::count_if(hits.begin(), hits.end(), [](const HitRecord& hit) { return hit.triangle != ~0u; }));
    if (!a.stats.empty()) {
        nlohmann::ordered_json json = device_stats(device);
        json["triangles"] = geometry.triangles.size();
        json["rays"] = rays.size();
        json["hits"] = found;
        json["hit"] = choice.hit == HitTest::exact ? "exact" : "planar";
        json["any_hit"] = a.any_hit;
        json["build_ms"] = build_ms;
        for (const PassTime& time : build_times) json["passes"].push_back({{"name", time.name}, {"ms", time.ms}});
        json["trace_ms"] = trace_ms;
        json["mrays_per_second"] = trace_ms > 0 ? nlohmann::ordered_json(double(rays.size()) / trace_ms * 1e-3) : nlohmann::ordered_json(nullptr);
        json["ldc"] = cube_stats(cube.grid, cube.counts, choice.ldc, cube.bytes().total(), builder.scratch_bytes(),
                                 choice.hit == HitTest::exact ? "conservative" : "centre");
        write_json(a.stats, json);
    }
    fmt::print("{}: {} rays, {} hits ({}), cube {}", a.hits.string(), rays.size(), found, choice.hit == HitTest::exact ? "exact" : "planar", choice.ldc);
    if (device.timestamp_period() > 0) fmt::print("; on the GPU: cube {:.2f} ms, rays {:.2f} ms", build_ms, trace_ms);
    fmt::print("; {}\n", device.info().name);
}

}  // namespace peelray
