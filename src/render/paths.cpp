#include "render/paths.h"

#include <optional>

namespace peelray {

std::vector<Binding> surfaces_of(const FrameState& f) {
    std::vector<Binding> surfaces = base_color_bindings(f.scene.base_colors);
    surfaces.push_back({"normals", f.scene.normals});
    surfaces.push_back({"frame", f.view.target.frame});
    surfaces.push_back({"lookups", f.scene.lookups});
    surfaces.push_back(Binding::if_used("media_ranks", f.scene.media_ranks));
    return if_used(surfaces);
}

namespace {

const char* scatter_name(bool filtered, bool drawn) {
    if (filtered) return drawn ? "scatter_filtered_drawn" : "scatter_filtered";
    return drawn ? "scatter_drawn" : "scatter";
}

void record_scatter(FrameState& f, const LevelParams& p) {
    PathQueues& queues = f.queues;
    const GpuScene& scene = f.scene;
    const PathLevel &level = queues.level(p.level), &next = queues.level(p.level + 1);
    const bool layered = f.layered();
    const bool camera = p.level == 0 && !layered;  // which makes its rays itself
    const std::vector<Binding> bindings =
        surface_bindings(scene, f.view.target.frame,
                         {Binding::if_used("rays", camera ? nullptr : &level.traced->rays),
                          Binding::if_used("states", camera ? nullptr : &level.traced->states),
                          Binding::if_used("hits", camera ? nullptr : &level.traced->hits),
                          {"nodes", level.nodes},
                          {"branches", level.branches},
                          {"queue", queues.counters()},
                          {"next_rays", next.traced->rays},
                          {"next_states", next.traced->states},
                          {"next_skip", next.traced->skip},
                          {"lights", scene.lights},
                          {"shadow_rays", queues.lights().rays},
                          {"shadow_skip", queues.lights().skip},
                          {"shadow_light", queues.lights().light},
                          {"visibility", f.view.target.visibility},
                          {"draws", scene.draw_table},
                          Binding::if_used("media_walls", level.traced->walls),
                          Binding::if_used("media_ranks", scene.media_ranks),
                          Binding::if_used("next_media", next.traced->media),
                          Binding::if_used("shadow_media", queues.lights().media)});
    // A GPU is faster where the compiler knows; a CPU would compile for seconds once more.
    const uint32_t sampled = f.constants.effects & EFFECT_SAMPLED ? 1 : 0;
    std::vector<Constant> constants{{"camera", camera},
                                    {"by_number", camera && f.view.by_number()},
                                    {"layered", layered},
                                    {"material_kinds", f.shaded_kinds()}};
    const bool drawn = f.env_sampled() || f.indirect() || f.emitting() || f.drawn_lamps() > 0 || f.soft_lamps() ||
                       f.photons != nullptr;
    if (drawn)
        constants.insert(constants.end(), {{"indirect", f.indirect()},
                                           {"emitting", f.emitting()},
                                           {"many_lamps", f.drawn_lamps() > 0},
                                           {"soft_lamps", f.soft_lamps()},
                                           {"photons", f.photon_ways()}});
    if (!f.env_filtered()) constants.push_back({"sampled", f.device.info().kind == "CPU" ? 2u : sampled});
    if (drawn && !f.env_filtered()) constants.push_back({"env_sampled", f.env_sampled()});
    const Pass& pass = f.device.pass(scatter_name(f.env_filtered(), drawn), constants);
    if (p.level == 0)
        f.commands.run(pass, bindings, p, groups_for(p.capacity, 64));
    else
        f.commands.run_indirect(pass, bindings, p, queues.counters(), PathQueues::groups_offset(p.level));
}

/// Entry `counter` of the counters says how many rays there are, entry `groups` for how many it is launched.
RayQueue queue_of(const PathQueues& queues, const Buffer& rays, const Buffer& skip, uint32_t capacity, uint32_t counter,
                  uint32_t groups) {
    return {rays,
            &skip,
            capacity,
            &queues.counters(),
            counter,
            &queues.counters(),
            PathQueues::groups_offset(groups),
            PathQueues::launch_offset(groups)};
}

void record_trace(FrameState& f, uint32_t level) {
    const PathRays& rays = *f.queues.level(level).traced;
    RayQueue queue = queue_of(f.queues, rays.rays, rays.skip, f.queues.level(level).capacity, level, level);
    std::optional<CountBuffers> counting;
    if (f.counter) queue.counting = &counting.emplace(f.counter->level(level));
    if (f.layered())
        f.tracer->trace_layered(f.commands, {queue, rays.hits, rays.media, rays.walls, false,
                                             f.scene.base_colors.constant(), surfaces_of(f)});
    else
        f.tracer->trace(f.commands, queue, rays.hits, {});
}

/// The camera's rays where media may overlap: in buffers, and followed through walls that are none to them.
void record_camera_walls(FrameState& f, const LevelParams& p) {
    record_primary(f.commands, f.device, f.scene, f.view.target, f.queues, p, f.view.by_number());
    const PathRays& rays = *f.queues.level(0).traced;
    f.tracer->trace_layered(f.commands, {RayQueue{rays.rays, nullptr, p.capacity}, rays.hits, rays.media, rays.walls,
                                         true, f.scene.base_colors.constant(), surfaces_of(f)});
}

void record_shadows(FrameState& f) {
    const LightQueue& lights = f.queues.lights();
    RayQueue queue = queue_of(f.queues, lights.rays, lights.skip, lights.capacity, QUEUE_LIGHT, QUEUE_GROUPS_LIGHT);
    std::optional<CountBuffers> counting;
    if (f.counter) queue.counting = &counting.emplace(f.counter->lights());
    f.tracer->shadow(f.commands, {queue, lights.light, f.scene.has_glass, f.layered() ? &lights.media : nullptr,
                                  f.scene.base_colors.constant(), surfaces_of(f)});
}

void record_gather(FrameState& f, const LevelParams& p) {
    PathQueues& queues = f.queues;
    f.commands.run_indirect(f.device.pass("gather"),
                            {{"nodes", queues.level(p.level).nodes},
                             {"branches", queues.level(p.level).branches},
                             {"next_nodes", queues.level(p.level + 1).nodes},
                             {"shadow_light", queues.lights().light},
                             {"queue", queues.counters()}},
                            p, queues.counters(), PathQueues::groups_offset(p.level));
}

}  // namespace

LevelParams level_params(const FrameState& f, uint32_t level, uint32_t sample, uint32_t first_row) {
    LevelParams p{};
    p.level = level;
    p.capacity = f.queues.level(level).capacity;
    p.next_capacity = f.queues.level(level + 1).capacity;
    p.sample_index = sample;
    p.jitter = sample_position(sample);
    p.first_row = first_row;
    p.light_capacity = f.queues.lights().capacity;
    // Level 0 holds exactly the band's pixels.
    if (level == 0) p.capacity = f.bands.pixels(first_row);
    return p;
}

/// Before light is gathered: in transparent pictures nodes then no longer know which shadow rays were theirs.
static void record_costs(FrameState& f, uint32_t sample, uint32_t first_row) {
    std::vector<LevelParams> params;
    for (uint32_t i = 0; i <= f.last_level; i++) params.push_back(level_params(f, i, sample, first_row));
    f.counter->record_sums(f.commands, f.queues, f.view.target.frame, params);
}

void record_paths(FrameState& f, uint32_t sample, uint32_t first_row) {
    for (uint32_t level = 0; level <= f.last_level; level++) {
        const LevelParams p = level_params(f, level, sample, first_row);
        if (level > 0)
            record_trace(f, level);
        else if (f.layered())
            record_camera_walls(f, p);
        record_scatter(f, p);
        if (f.photons) f.photons->record_gather(f, p);
    }
    if (f.lights_per_hit() > 0) record_shadows(f);
    if (f.counter) record_costs(f, sample, first_row);
    // Where nothing is traced from a level there is nothing to gather but, in transparent pictures, what it lets
    // through.
    const uint32_t ends = f.last_level + (f.settings.backdrop.is_transparent() ? 1 : 0);
    for (uint32_t level = ends; level-- > 1;) record_gather(f, level_params(f, level, sample, first_row));
}

}  // namespace peelray
