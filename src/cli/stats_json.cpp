#include "cli/stats_json.h"

#include <fstream>
#include <map>
#include <span>

#include "base/error.h"
#include "cli/version.h"
#include "image/image.h"

namespace peelray {

using Json = nlohmann::ordered_json;

Json machine_json(const Machine& machine) {
    return {{"device", machine.name},
            {"kind", machine.kind},
            {"driver", machine.driver},
            {"api_version", machine.api_version.empty() ? Json(nullptr) : Json(machine.api_version)},
            {"commit", build_commit()}};
}

template <typename T>
static Json box_json(const glm::vec<3, T>& lower, const glm::vec<3, T>& upper) {
    return {{"lower", {lower.x, lower.y, lower.z}}, {"upper", {upper.x, upper.y, upper.z}}};
}

/// A box of the scene in the world, which takes double precision far from its origin.
static Json box_json(const Box& box, const glm::dvec3& origin) {
    if (origin == glm::dvec3(0)) return box_json(box.lower, box.upper);
    return box_json(origin + glm::dvec3(box.lower), origin + glm::dvec3(box.upper));
}

/// One cube, in the space of its body.
static Json body_json(const LdcBody& body, uint32_t instances, bool fixed) {
    const CubeGrid& grid = body.grid;
    // A bare body has a grid, but nothing in it.
    const bool bare = body.resolution & LDC_BARE;
    const glm::uvec3 voxels = bare ? glm::uvec3(0) : grid.dims;
    return {{"triangles", body.triangles},
            {"instances", instances},
            {"bare", bare},
            {"built", bare    ? "never"
                      : fixed ? "once"
                              : "every frame"},
            {"n", bare ? 0 : body.resolution},
            {"voxels", {voxels.x, voxels.y, voxels.z}},
            {"voxel_size", bare ? 0 : grid.voxel},
            {"box", box_json(grid.origin, grid.origin + glm::vec3(grid.dims) * grid.voxel)}};
}

/// `shown`: instances of each body.
static Json cubes_json(const SceneCubes::Stats& cubes, const std::vector<LdcBody>& bodies,
                       const std::vector<uint32_t>& shown, const Box& box, const glm::dvec3& origin,
                       const CubeChoice& choice) {
    const bool by_pixel = choice.layout.by_pixel();
    Json json = {
        {"n", cubes.resolution},
        {"box", box_json(box, origin)},
        {"builder", name_of(choice.layout.builder)},
        {"traversal", name_of(choice.layout.traversal)},
        {"block",
         choice.layout.traversal == Traversal::two_level ? Json{choice.layout.block.x, choice.layout.block.y} : Json()},
        {"sampling", choice.hit == HitTest::exact    ? "conservative"
                     : choice.hit == HitTest::planar ? "centre and band"
                                                     : "centre"},
        {"samples", cubes.counts.fragments},
        {"layers", cubes.counts.longest},
        {"layers_of", by_pixel ? "pixel" : "voxel list"},
        {by_pixel ? "occupied_pixels" : "occupied_voxels", cubes.counts.voxels},
        {"occupied_nodes", cubes.counts.nodes},
        {"bytes", cubes.bytes},
        {"build_scratch_bytes", cubes.scratch_bytes},
        {"triangles_without_area", cubes.counts.degenerate},
        {"triangles_not_finite", cubes.counts.invalid},
        {"count", cubes.cubes()},
        {"bare_bodies", cubes.bare},
        {"no_room", nullptr}};
    // What the boxes of cubes are relative to.
    if (origin != glm::dvec3(0)) json["origin"] = {origin.x, origin.y, origin.z};
    if (!cubes.no_room.empty())
        json["no_room"] = {
            {"n", cubes.no_room_resolution}, {"hit", name_of(cubes.no_room_hit)}, {"why", cubes.no_room}};
    if (cubes.counts.refined != 0) {
        json["refined_voxels"] = cubes.counts.refined;
        json["refined_samples"] = cubes.counts.fine;
    }
    if (cubes.merged != 0) json["merged"] = {{"instances", cubes.merged}, {"triangles", cubes.merged_triangles}};
    if (by_pixel) {
        json["depth_bits"] = choice.layout.half_depth ? 16 : 32;
        json["batch"] = name_of(choice.layout.batch);
    }
    if (choice.hit == HitTest::tolerance) json["tolerance"] = choice.tolerance;
    if (choice.layout.builder != BuilderKind::compute) json["routing"] = name_of(choice.layout.routing);
    if (choice.layout.builder == BuilderKind::peel)
        json["peeling"] = {{"depth_complexity", cubes.counts.complexity}, {"passes", cubes.counts.passes}};
    for (size_t i = 0; i < std::min<size_t>(bodies.size(), 64); i++)
        json["cubes"].push_back(body_json(bodies[i], shown[i], i < cubes.fixed));
    return json;
}

Json kind_costs_json(const KindCosts& cost) {
    Json mean, half, most, largest;
    for (size_t i = 0; i < kRayCostFields.size(); i++) {
        const char* name = kRayCostFields[i].name;
        mean[name] = cost.mean(i);
        half[name] = cost.percentile(i, 0.5);
        most[name] = cost.percentile(i, 0.99);
        largest[name] = cost.largest.*kRayCostFields[i].value;
    }
    return {{"rays", cost.rays}, {"mean", mean}, {"p50", half}, {"p99", most}, {"largest", largest}};
}

/// What rays of some kinds cost, named by `names`.
static Json costs_json(const AllKindCosts& costs, std::span<const char* const> names) {
    Json json = {{"times", "counting slows the rays: the times here are not to be trusted"}};
    for (size_t kind = 0; kind < names.size(); kind++) json[names[kind]] = kind_costs_json(costs[kind]);
    return json;
}

static Json allocations_json(const std::vector<Allocation>& allocations) {
    uint64_t sum = 0;
    std::map<std::string, std::map<std::string, uint64_t>> parts;
    for (const Allocation& allocation : allocations) {
        sum += allocation.bytes;
        parts[allocation.part][allocation.name] += allocation.bytes;
    }
    Json json = {{"bytes", sum}, {"parts", Json::object()}};
    for (const auto& [part, buffers] : parts) {
        uint64_t bytes = 0;
        for (const auto& [name, size] : buffers) bytes += size;
        json["parts"][part] = {{"bytes", bytes}, {"buffers", buffers}};
    }
    return json;
}

/// All device memory by part and buffer, now and at the peak: sums are those of the device.
static Json memory_json(const std::vector<Allocation>& now, const std::vector<Allocation>& peak) {
    Json json = allocations_json(now);
    json["peak"] = allocations_json(peak);
    return json;
}

static Json picture_costs_json(const PictureStats& stats) {
    constexpr const char* names[] = {"reflection_and_refraction", "shadow"};
    Json json = costs_json(stats.render.costs, names);
    for (const RayCostField& field : kRayCostFields)
        json["largest_of_a_pixel"][field.name] = stats.largest_of_a_pixel.*field.value;
    return json;
}

Json rays_json(const RayCounts& rays) {
    return {{"primary", rays.primary},
            {"reflection", rays.reflection},
            {"refraction", rays.refraction},
            {"diffuse", rays.diffuse},
            {"shadow", rays.shadow},
            {"ambient", rays.ambient},
            {"cut", {{"reflection", rays.cut_reflection}, {"refraction", rays.cut_refraction}}},
            {"crowded", rays.crowded}};
}

static Json maps_json(const RenderStats& stats) {
    const CubeMaps::Stats& m = stats.maps;
    return {{"maps_ms", stats.maps_ms},
            {"probes",
             {{"count", m.probes},
              {"face", m.face},
              {"rounds", m.rounds},
              {"samples", m.samples},
              {"bytes", m.probe_bytes},
              {"objects_left_out", m.left_out}}},
            {"shadow_maps",
             {{"count", m.shadows.maps},
              {"size", m.shadows.size},
              {"face_of_six", m.shadows.face_size},
              {"bytes", m.shadows.bytes}}}};
}

/// `update`: of the structures that are not kept.
static Json structures_json(const Structures::Stats& s, StructureUpdate update) {
    return {{"structures", s.bodies},
            {"kept", s.kept},
            {"built", s.kept == s.bodies ? "once" : name_of(update)},
            {"bytes", s.bytes},
            {"build_scratch_bytes", s.scratch_bytes},
            {"kept_bytes", s.kept_bytes},
            {"kept_bytes_before_compaction", s.loose_bytes}};
}

Json cubes_json(const PictureStats& stats) {
    const RenderStats& s = stats.render;
    return stats.has_cubes() ? cubes_json(s.cubes, s.bodies, s.shown, stats.box, stats.origin, s.choice)
                             : Json(nullptr);
}

Json memory_bytes_json(const RenderStats& s) {
    return {{"scene", s.scene_bytes},
            {"cube", s.cubes.bytes},
            {"acceleration_structures", s.structures.bytes},
            {"build_scratch", s.cubes.scratch_bytes + s.structures.scratch_bytes},
            {"frame", s.frame_bytes},
            {"peak", s.peak_bytes}};
}

static Json rates_json(const PictureStats& stats) {
    double trace_ms = 0, shadow_ms = 0;
    for (const PassTime& pass : stats.render.passes) {
        if (pass.name.starts_with("trace_shadow"))
            shadow_ms = pass.ms;
        else if (pass.name.starts_with("trace"))
            trace_ms = pass.ms;
    }
    const auto rate = [](uint64_t rays, double ms) { return ms > 0 ? Json(double(rays) / ms * 1e-3) : Json(nullptr); };
    const RayCounts& rays = stats.rays;
    return {{"reflection_and_refraction", rate(rays.reflection + rays.refraction + rays.diffuse, trace_ms)},
            {"shadow_and_ambient", rate(rays.shadow + rays.ambient, shadow_ms)}};
}

/// Of each pixel: how many, why no more, and how noisy they leave the picture, where that is known.
static Json samples_json(const SamplesMade& samples) {
    return {{"count", samples.count},
            {"end", name_of(samples.end)},
            {"noise", samples.noise ? Json(*samples.noise) : Json(nullptr)}};
}

/// What only a device's picture has.
static void add_render_json(Json& json, const PictureStats& stats) {
    const RenderStats& s = stats.render;
    json["mrays_per_second"] = rates_json(stats);
    if (stats.has_cubes()) {
        json["ldc"] = cubes_json(stats);
        json["moved"] = {{"cubes_rebuilt", s.rebuilt},
                         {"cubes_reused", s.cubes.bodies - s.rebuilt},
                         {"instances_transformed", s.moved}};
    }
    if (s.counted) json["counters"] = picture_costs_json(stats);
    if (s.tracer == Tracer::cubemap) json["cubemap"] = maps_json(s);
    json["bands"] = {{"count", s.bands}, {"rows", s.band_rows}};
    json["visibility"] = s.visibility == Visibility::compute ? "compute" : "raster";
    if (s.tracer == Tracer::khr) json["khr"] = structures_json(s.structures, s.update);
    json["hit"] = stats.has_cubes() ? name_of(s.hit) : "none";
    json["memory_bytes"] = memory_bytes_json(s);
    json["memory"] = memory_json(s.memory, s.peak_memory);
    json["redone"] = s.redone;
}

/// As --eye, --look, --up and --fov take it.
static Json camera_json(const Camera& camera, const glm::dvec3& origin) {
    const auto list = [](const auto& v) { return Json::array({v.x, v.y, v.z}); };
    Json json = {{"eye", list(camera.eye + origin)}, {"look", list(camera.look + origin)}, {"up", list(camera.up)}};
    if (camera.orthographic_height > 0)
        json["orthographic_height"] = camera.orthographic_height;
    else
        json["fov"] = glm::degrees(double(camera.vertical_fov));
    return json;
}

Json picture_json(const PictureStats& stats) {
    const RenderStats& s = stats.render;
    Json json = {{"tracer", name_of(s.tracer)}};
    json.update(machine_json(stats.machine));
    json["image"] = {stats.width, stats.height};
    json["camera"] = camera_json(stats.camera, stats.origin);
    json["samples"] = samples_json(stats.samples);
    json["triangles"] = stats.triangles;
    json["timed"] = s.timed;
    json["frame_ms"] = s.frame_ms;
    json["build_ms"] = s.build_ms;
    for (const PassTime& pass : s.passes) json["passes"].push_back({{"name", pass.name}, {"ms", pass.ms}});
    json["rays"] = rays_json(stats.rays);
    if (stats.warm_up_pictures > 0) json["warm_up"] = {{"frames", stats.warm_up_pictures}, {"ms", stats.warm_up_ms}};
    if (stats.rays.photons > 0) json["photons"] = {{"sent", stats.rays.photons}, {"kept", stats.rays.photons_kept}};
    if (stats.by_cpu())
        json["hit"] = s.tracer == Tracer::cpu ? "single" : "double";
    else
        add_render_json(json, stats);
    return json;
}

Json trace_json(const TraceStats& s) {
    Json json = {{"tracer", s.structures ? "khr" : "ldc"}};
    json.update(machine_json(s.machine));
    json["triangles"] = s.triangles;
    json["rays"] = s.rays;
    json["hits"] = s.hits;
    json["hit"] = s.structures ? "none" : name_of(s.choice.hit);
    json["any_hit"] = s.any_hit;
    json["build_ms"] = s.build_ms;
    for (const PassTime& time : s.build_passes) json["passes"].push_back({{"name", time.name}, {"ms", time.ms}});
    json["passes"].push_back({{"name", "trace"}, {"ms", s.trace_ms}});
    json["trace_ms"] = s.trace_ms;
    json["mrays_per_second"] = nullptr;
    if (s.trace_ms > 0) json["mrays_per_second"] = double(s.rays) / s.trace_ms * 1e-3;
    constexpr const char* kind = "rays";
    if (s.costs) json["counters"] = costs_json(*s.costs, std::span(&kind, 1));
    if (s.structures) {
        json["khr"] = structures_json(*s.structures, StructureUpdate::keep);
        return json;
    }
    json["ldc"] = cubes_json(s.cubes, s.bodies, s.shown, s.box, s.origin, s.choice);
    json["memory"] = memory_json(s.memory, s.peak_memory);
    return json;
}

/// For write_atomically() and the like: writes to the temporary name; `path` is for the message.
static auto json_writer(const std::filesystem::path& path, const Json& json) {
    return [&](const std::filesystem::path& temporary) {
        std::ofstream stream(temporary);
        stream << json.dump(2, ' ', false, Json::error_handler_t::replace) << "\n";
        stream.close();
        if (!stream) fail("cannot write '{}': is the disk full?", path.string());
    };
}

void write_json(const std::filesystem::path& path, const Json& json) {
    write_atomically(path, json_writer(path, json));
}

bool write_json_if_absent(const std::filesystem::path& path, const Json& json) {
    return write_if_absent(path, json_writer(path, json));
}

}  // namespace peelray
