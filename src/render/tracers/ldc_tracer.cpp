#include "render/tracers/ldc_tracer.h"

#include <utility>

#include "render/transforms.h"

namespace peelray {

LdcTracer::LdcTracer(const TracedWorld& world, const TracerChoice& choice)
    : device_(world.device),
      triangles_(world.triangles),
      instances_(world.instances),
      may_merge_(world.merged),
      merged_(nullptr),
      scales_(smallest_scales(world.assembly, world.worlds)),
      first_choice_(choice.cubes),
      fixed_bodies_(choice.fixed_bodies(world.assembly)),
      shown_(world.assembly.bodies.size()) {
    assembly_.bodies = world.assembly.bodies;
    for (const Assembly::Instance& instance : world.assembly.instances) shown_[instance.body]++;
    merge(true);
    make(first_choice_);
}

/// Those that come after it see every instance for itself.
LdcTracer::~LdcTracer() {
    instances_.separate();
}

void LdcTracer::merge(bool on) {
    merged_ = on ? may_merge_ : nullptr;
    if (merged_)
        instances_.merge(merged_->merged());
    else
        instances_.separate();
}

void LdcTracer::make(const CubeChoice& choice) {
    cubes_.reset();  // first, so that both never live at once
    Assembly assembly = assembly_;
    std::vector<float> scales = scales_;
    uint32_t fixed = fixed_bodies_;
    if (merged_) {
        if (!merged_->moves() && fixed == assembly.bodies.size()) fixed++;
        assembly.bodies.push_back(merged_->body());
        scales.push_back(1);
    }
    cubes_ = std::make_unique<SceneCubes>(device_, assembly, choice, fixed, scales);
    copied_ = false;
}

TracedScene LdcTracer::traced() const {
    TracedScene scene{cubes_->cubes(), instances_, triangles_};
    if (merged_) {
        scene.copied = &merged_->copied();
        scene.first_copy = merged_->body().first_triangle;
    }
    return scene;
}

/// Throws Error where nothing smaller may be made.
void LdcTracer::make_smaller(const NoRoom& error) {
    const CubeChoice failed = choice();
    if (merged_) {
        merge(false);
        return make(failed);
    }
    if (no_room_.empty()) no_room_ = error.reason();
    if (const std::optional<CubeChoice> smaller = smaller_than(failed)) return make(*smaller);
    const std::string found = fmt::format("{}, for {} hits at N = {}{}", no_room_, name_of(first_choice_.hit),
                                          largest_resolution(assembly_, first_choice_, fixed_bodies_),
                                          failed == first_choice_ ? "" : ", and for what is smaller");
    // The corners of the triangles are as many at any resolution.
    const bool coarser_helps = failed.hit != HitTest::exact || !cubes_->cubes().has_patches() ||
                               triangles_.count <= most_exact_triangles(device_);
    if (failed.ldc != 0 && coarser_helps)
        fail("{}: use {} auto, which takes what fits, or a smaller one", found, setting::ldc);
    if (failed.hit == HitTest::exact) fail("{}: use {} auto, which takes what fits", found, setting::hit);
    fail("{}: choose another {}, or {} reference, which renders without one", found, setting::device, setting::tracer);
}

/// The first choice that finds room for this moment: what was made for an earlier one is no reason for less.
void LdcTracer::build(Commands& commands, const std::function<void()>& animate, FrameMeter& meter) {
    const bool deforms = cubes_->fixed() < bodies().bodies().size();
    if (!fits_ && deforms && !no_room_.empty()) {
        no_room_.clear();
        merge(true);
        make(first_choice_);
    }
    for (;; meter.redone++) {
        try {
            return build_once(commands, animate, meter);
        } catch (const NoRoom& error) {
            make_smaller(error);
        }
    }
}

void LdcTracer::build_once(Commands& commands, const std::function<void()>& animate, FrameMeter& meter) {
    rebuilt_ = uint32_t(bodies().bodies().size()) - cubes_->fixed();
    if (builds_once() && !std::exchange(copied_, true)) record_copies(commands);
    if (cubes_->build_fixed(commands, triangles_)) {
        meter.add(commands);
        meter.redone += cubes_->stats().redone;
        rebuilt_ += cubes_->fixed();
    }
    for (;; meter.redone++) {
        animate();
        record_rebuild(commands);
        // Rays must not walk through cubes that did not find room, so that the host looks first; but once.
        if (fits_) return;
        commands.submit();
        if (!finish_rebuild(commands)) continue;
        meter.add(commands);
        fits_ = true;
        return;
    }
}

void LdcTracer::record_copies(Commands& commands) {
    if (merged_) merged_->record(commands, bodies(), triangles_, instances_);
}

void LdcTracer::record_rebuild(Commands& commands) {
    if (!builds_once()) record_copies(commands);
    cubes_->record(commands, triangles_);
    instances_.record(commands, bodies());
}

void LdcTracer::trace(Commands& commands, const RayQueue& queue, const Buffer& hits, const TraceQuery& query) {
    record_trace(commands, device_, traced(), queue, hits,
                 {choice().hit, choice().tolerance, query.any_hit, query.edges});
}

TraceParams LdcTracer::params(const RayQueue& queue) const {
    TraceParams p = trace_params(traced(), queue);
    p.tolerance = tolerance();
    return p;
}

void LdcTracer::trace_layered(Commands& commands, const LayeredRays& rays) {
    const RayQueue& queue = rays.rays;
    std::vector<Binding> bindings =
        cube_bindings(traced(), {{"rays", queue.rays},
                                 Binding::if_used("skip", queue.skip),
                                 Binding::if_used("queue", queue.counters),
                                 {"hits", rays.hits},
                                 {"media", rays.media},
                                 {"media_walls", rays.walls},
                                 Binding::if_used("costs", queue.counting ? &queue.counting->costs : nullptr),
                                 Binding::if_used("count_totals", queue.counting ? &queue.counting->totals : nullptr)});
    bindings.insert(bindings.end(), rays.surfaces.begin(), rays.surfaces.end());
    Constants constants = traversal_constants(device_, traced(), choice().hit, queue.counting != nullptr);
    constants.push_back({"camera", rays.camera});
    constants.push_back(rays.materials);
    const Pass& pass = device_.pass(choice().layout.by_pixel() ? "trace_media_pixels" : "trace_media", constants);
    if (queue.groups)
        commands.run_indirect(pass, bindings, params(queue), *queue.groups, queue.groups_offset);
    else
        commands.run(pass, bindings, params(queue), groups_for(queue.count, 64));
}

void LdcTracer::shadow(Commands& commands, const ShadowRays& shadows) {
    const RayQueue& queue = shadows.rays;
    std::vector<Binding> bindings =
        cube_bindings(traced(), {{"shadow_rays", queue.rays},
                                 {"shadow_skip", *queue.skip},
                                 {"shadow_light", shadows.light},
                                 {"queue", *queue.counters},
                                 Binding::if_used("shadow_media", shadows.media),
                                 Binding::if_used("costs", queue.counting ? &queue.counting->costs : nullptr),
                                 Binding::if_used("count_totals", queue.counting ? &queue.counting->totals : nullptr)});
    if (shadows.glass)
        bindings.insert(bindings.end(), shadows.surfaces.begin(), shadows.surfaces.end());
    else
        bindings = with_hit_materials(bindings, triangles_);
    Constants constants = traversal_constants(device_, traced(), choice().hit, queue.counting != nullptr);
    if (shadows.glass) constants.push_back(shadows.materials);
    const std::string through = shadows.media ? "_media" : shadows.glass ? "_glass" : "";
    const Pass& pass =
        device_.pass("trace_shadow" + through + (choice().layout.by_pixel() ? "_pixels" : ""), constants);
    commands.run_indirect(pass, bindings, params(queue), *queue.groups, queue.groups_offset);
}

void LdcTracer::describe(Frame& frame) const {
    // Planar hits know a surface to about a voxel: a ray counts from beyond the reach of its own surface's samples,
    // which accept hits up to 0.7 voxels beside them. Measured against the reference (docs/accuracy.md): 1.0 and 1.5
    // lose contact shadows and nothing is gained.
    // Within the tolerance of a sample a hit may lie by that and by what the surface rises over half a pixel either
    // way, which is at most 0.58 voxels along its normal.
    const HitTest hit = choice().hit;
    frame.surface_offset = hit == HitTest::planar ? 0.7f : hit == HitTest::tolerance ? 0.6f : 0;
    frame.tolerance = tolerance();
    frame.block = choice().layout.block;
}

void LdcTracer::describe(Commands& commands, TracerStats& stats, bool of_bodies) const {
    stats.cubes = cubes_->stats();
    stats.cubes.no_room = no_room_;
    if (merged_) {
        stats.cubes.merged = uint32_t(merged_->merged().instances.size());
        stats.cubes.merged_triangles = merged_->body().triangles;
        stats.cubes.bytes += merged_->bytes();
    }
    if (!no_room_.empty()) {
        stats.cubes.no_room_hit = first_choice_.hit;
        stats.cubes.no_room_resolution = largest_resolution(assembly_, first_choice_, fixed_bodies_);
    }
    if (of_bodies) stats.bodies = bodies().download(commands);
    stats.shown = shown_;
    if (merged_) stats.shown.push_back(1);
    stats.rebuilt = rebuilt_;
}

}  // namespace peelray
