#include "cli/stats.h"

#include <fstream>
#include <map>

#include "base/error.h"
#include "cli/program.h"
#include "image/image.h"

namespace peelray {

using Json = nlohmann::ordered_json;

Json device_stats(const Device& device) {
    return {{"device", device.info().name},
            {"kind", device.info().kind},
            {"driver", device.info().driver},
            {"api_version", device.info().api_version},
            {"commit", build_commit()}};
}

static Json box_stats(const glm::vec3& lower, const glm::vec3& upper) {
    return {{"lower", {lower.x, lower.y, lower.z}}, {"upper", {upper.x, upper.y, upper.z}}};
}

/// One cube, in the space of its body.
static Json body_stats(const LdcBody& body, uint32_t instances, bool fixed) {
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
            {"box", box_stats(grid.origin, grid.origin + glm::vec3(grid.dims) * grid.voxel)}};
}

std::string count_of_cubes(const SceneCubes::Stats& cubes) {
    return fmt::format("{} cube{} of up to {}", cubes.cubes(), cubes.cubes() == 1 ? "" : "s", cubes.resolution);
}

std::string tolerance_note(const std::vector<LdcBody>& bodies, const CubeChoice& choice) {
    if (choice.hit != HitTest::tolerance) return {};
    // Between the centres of two pixels a surface of slope 1 rises by half a voxel over its sample.
    const LdcBody* worst = nullptr;
    const auto voxels = [](const LdcBody& body) { return body.tolerance * body.grid.inv_voxel; };
    // What is flat along an axis does not slope.
    const auto flat = [](const LdcBody& body) {
        return std::min({body.grid.dims.x, body.grid.dims.y, body.grid.dims.z}) <= 16;
    };
    for (const LdcBody& body : bodies)
        if (!flat(body) && (!worst || voxels(body) < voxels(*worst))) worst = &body;
    if (!worst || !(voxels(*worst) < 0.5f)) return {};
    return fmt::format(
        "the tolerance of {:.3g} is {:.2g} pixels of a cube: rays slip through sloping surfaces; --tolerance {:.2g} "
        "makes "
        "it a pixel",
        choice.tolerance, voxels(*worst), choice.tolerance / voxels(*worst));
}

Json cube_stats(const SceneCubes::Stats& cubes, const std::vector<LdcBody>& bodies, const std::vector<uint32_t>& shown,
                const Box& box, const CubeChoice& choice) {
    const bool by_pixel = choice.layout.by_pixel();
    Json json = {
        {"n", cubes.resolution},
        {"box", box_stats(box.lower, box.upper)},
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
        {"bare_bodies", cubes.bare}};
    if (by_pixel) {
        json["depth_bits"] = choice.layout.half_depth ? 16 : 32;
        json["batch"] = name_of(choice.layout.batch);
    }
    if (choice.hit == HitTest::tolerance) json["tolerance"] = choice.tolerance;
    if (choice.layout.builder != BuilderKind::compute) json["routing"] = name_of(choice.layout.routing);
    if (choice.layout.builder == BuilderKind::peel)
        json["peeling"] = {{"depth_complexity", cubes.counts.complexity}, {"passes", cubes.counts.passes}};
    for (size_t i = 0; i < std::min<size_t>(bodies.size(), 64); i++)
        json["cubes"].push_back(body_stats(bodies[i], shown[i], i < cubes.fixed));
    return json;
}

Json counter_stats(const AllKindCosts& costs, std::span<const char* const> names) {
    Json json = {{"times", "counting slows the rays: the times here are not to be trusted"}};
    for (size_t kind = 0; kind < names.size(); kind++) {
        const KindCosts& cost = costs[kind];
        Json mean, largest;
        for (size_t i = 0; i < kRayCostFields.size(); i++) {
            mean[kRayCostFields[i].name] = cost.mean(i);
            largest[kRayCostFields[i].name] = cost.largest.*kRayCostFields[i].value;
        }
        json[names[kind]] = {{"rays", cost.rays}, {"mean", mean}, {"largest", largest}};
    }
    return json;
}

static Json allocation_stats(const std::vector<Allocation>& allocations) {
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

Json memory_stats(const std::vector<Allocation>& now, const std::vector<Allocation>& peak) {
    Json json = allocation_stats(now);
    json["peak"] = allocation_stats(peak);
    return json;
}

/// Of a picture; `costs`: of its pixels.
static Json picture_counters(const AllKindCosts& kinds, const std::vector<RayCosts>& costs) {
    constexpr const char* names[] = {"reflection_and_refraction", "shadow"};
    Json json = counter_stats(kinds, names);
    for (const RayCostField& field : kRayCostFields) json["largest_of_a_pixel"][field.name] = largest_of(costs, field);
    return json;
}

Json ray_stats(const RayCounts& rays) {
    return {{"primary", rays.primary},
            {"reflection", rays.reflection},
            {"refraction", rays.refraction},
            {"shadow", rays.shadow},
            {"ambient", rays.ambient}};
}

static Json map_stats(const RenderStats& stats) {
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

Json structure_stats(const Structures::Stats& s, StructureUpdate update) {
    return {{"structures", s.bodies},
            {"kept", s.kept},
            {"built", s.kept == s.bodies ? "once" : name_of(update)},
            {"bytes", s.bytes},
            {"build_scratch_bytes", s.scratch_bytes},
            {"kept_bytes", s.kept_bytes},
            {"kept_bytes_before_compaction", s.loose_bytes}};
}

static const char* name_of(Tracer tracer) {
    switch (tracer) {
        case Tracer::ldc:
            return "ldc";
        case Tracer::khr:
            return "khr";
        case Tracer::cubemap:
            return "cubemap";
        case Tracer::none:
            return "none";
    }
    return "";
}

Json render_stats(const Device& device, const RenderResult& result, uint64_t triangles, const Box& box) {
    const RenderStats& s = result.stats;
    Json json = {{"tracer", name_of(s.tracer)}};
    json.update(device_stats(device));
    json["image"] = {result.width, result.height};
    json["triangles"] = triangles;
    json["timed"] = s.timed;
    json["frame_ms"] = s.frame_ms;
    json["build_ms"] = s.build_ms;
    double trace_ms = 0, shadow_ms = 0;
    for (const auto& pass : s.passes) {
        json["passes"].push_back({{"name", pass.name}, {"ms", pass.ms}});
        if (pass.name.starts_with("trace_shadow"))
            shadow_ms = pass.ms;
        else if (pass.name.starts_with("trace"))
            trace_ms = pass.ms;
    }
    const auto rate = [](uint64_t rays, double ms) { return ms > 0 ? Json(double(rays) / ms * 1e-3) : Json(nullptr); };
    json["rays"] = ray_stats(result.rays);
    json["mrays_per_second"] = {
        {"reflection_and_refraction", rate(result.rays.reflection + result.rays.refraction, trace_ms)},
        {"shadow_and_ambient", rate(result.rays.shadow + result.rays.ambient, shadow_ms)}};
    if (s.cubes.bodies) {
        json["ldc"] = cube_stats(s.cubes, s.bodies, s.shown, box, s.choice);
        json["moved"] = {{"cubes_rebuilt", s.rebuilt},
                         {"cubes_reused", s.cubes.bodies - s.rebuilt},
                         {"instances_transformed", s.moved}};
    }
    if (s.counted) json["counters"] = picture_counters(s.costs, result.aovs.costs);
    if (s.tracer == Tracer::cubemap) json["cubemap"] = map_stats(s);
    json["visibility"] = s.visibility == Visibility::compute ? "compute" : "raster";
    if (s.tracer == Tracer::khr) json["khr"] = structure_stats(s.structures, s.update);
    json["hit"] = s.cubes.bodies ? name_of(s.hit) : "none";
    json["memory_bytes"] = {{"scene", s.scene_bytes},
                            {"cube", s.cubes.bytes},
                            {"acceleration_structures", s.structures.bytes},
                            {"build_scratch", s.cubes.scratch_bytes + s.structures.scratch_bytes},
                            {"frame", s.frame_bytes},
                            {"peak", s.peak_bytes}};
    json["memory"] = memory_stats(s.memory, s.peak_memory);
    json["redone"] = s.redone;
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
