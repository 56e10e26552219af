#include "render/tracers/ldc_tracer.h"

#include "render/transforms.h"

namespace peelray {

LdcTracer::LdcTracer(const TracedWorld& world, const TracerChoice& choice)
    : device_(world.device),
      triangles_(world.triangles),
      instances_(world.instances),
      cubes_(world.device, world.assembly, choice.cubes, choice.fixed_bodies(world.assembly),
             smallest_scales(world.assembly, world.worlds)),
      shown_(world.assembly.bodies.size()) {
    for (const Assembly::Instance& instance : world.assembly.instances) shown_[instance.body]++;
}

void LdcTracer::build(Commands& commands, const std::function<void()>& animate, FrameMeter& meter) {
    rebuilt_ = uint32_t(bodies().bodies().size()) - cubes_.fixed();
    if (cubes_.build_fixed(commands, triangles_)) {
        meter.add(commands);
        meter.redone += cubes_.stats().redone;
        rebuilt_ += cubes_.fixed();
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

void LdcTracer::record_rebuild(Commands& commands) {
    cubes_.record(commands, triangles_);
    instances_.record(commands, bodies());
}

void LdcTracer::trace(Commands& commands, const RayQueue& queue, const Buffer& hits, const TraceQuery& query) {
    record_trace(commands, device_, traced(), queue, hits,
                 {choice().hit, choice().tolerance, query.any_hit, query.edges});
}

void LdcTracer::shadow(Commands& commands, const ShadowRays& shadows) {
    const RayQueue& queue = shadows.rays;
    TraceParams p{};
    p.tree = instances_.tree();
    p.count = queue.count;
    p.tolerance = tolerance();
    p.block = choice().layout.block;
    std::vector<Binding> bindings =
        cube_bindings(traced(), {{"shadow_rays", queue.rays},
                                 {"shadow_skip", *queue.skip},
                                 {"shadow_light", shadows.light},
                                 {"queue", *queue.counters},
                                 Binding::if_used("costs", queue.counting ? &queue.counting->costs : nullptr),
                                 Binding::if_used("count_totals", queue.counting ? &queue.counting->totals : nullptr)});
    if (shadows.glass)
        bindings.insert(bindings.end(), shadows.surfaces.begin(), shadows.surfaces.end());
    else
        bindings = with_hit_materials(bindings, triangles_);
    const Pass& pass = device_.pass(std::string(shadows.glass ? "trace_shadow_glass" : "trace_shadow") +
                                        (choice().layout.by_pixel() ? "_pixels" : ""),
                                    traversal_constants(device_, traced(), choice().hit, queue.counting != nullptr));
    commands.run_indirect(pass, bindings, p, *queue.groups, queue.groups_offset);
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

void LdcTracer::describe(Commands& commands, TracerStats& stats) const {
    stats.cubes = cubes_.stats();
    stats.bodies = bodies().download(commands);
    stats.shown = shown_;
    stats.rebuilt = rebuilt_;
}

}  // namespace peelray
