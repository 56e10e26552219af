#include "render/tracers/khr_tracer.h"

#include "khr/khr_params.h"
#include "khr/tracer.h"
#include "render/tracers/no_tracer.h"

namespace peelray {
namespace {

std::vector<StructureBody> updated(std::vector<StructureBody> bodies, const TracerChoice& choice, uint32_t fixed) {
    for (size_t i = 0; i < bodies.size(); i++) bodies[i].update = i < fixed ? StructureUpdate::keep : choice.structures;
    return bodies;
}

}  // namespace

KhrTracer::KhrTracer(const TracedWorld& world, const TracerChoice& choice)
    : device_(world.device),
      triangles_(world.triangles),
      instances_(world.instances),
      update_(choice.structures),
      structures_(world.device, world.triangles, world.instances,
                  updated(world.structures, choice, choice.fixed_bodies(world.assembly))),
      bodies_(plain_bodies(world.device, world.assembly)) {}

void KhrTracer::pose(bool moved) {
    moved_ = moved || (moved_ && !built_);
    built_ = false;
}

void KhrTracer::build(Commands& commands, const std::function<void()>& animate, FrameMeter& meter) {
    animate();
    instances_.record(commands, bodies_, false);
    structures_.build_kept(commands, [&] { meter.add(commands); });
    structures_.record(commands, moved_);
    commands.submit();
    meter.add(commands);
    built_ = true;
}

void KhrTracer::trace(Commands& commands, const RayQueue& queue, const Buffer& hits, const TraceQuery& query) {
    record_khr_trace(commands, device_, structures_, triangles_, queue, hits, query.any_hit);
}

std::vector<Binding> KhrTracer::with_surfaces(const std::vector<Binding>& surfaces) const {
    std::vector<Binding> bindings = surfaces;
    bindings.push_back(Binding::if_used("positions", triangles_.positions));
    bindings.push_back(Binding::if_used("triangles", triangles_.triangles));
    bindings.push_back(Binding::if_used("instances", instances_.table()));
    return bindings;
}

void KhrTracer::trace_layered(Commands& commands, const LayeredRays& rays) {
    const RayQueue& queue = rays.rays;
    const RayPass& pass =
        khr_pass(device_, "trace_media_khr", KhrRays::nearest, triangles_, {{"camera", rays.camera}, rays.materials});
    const KhrTraceParams p{queue.count, queue.counters != nullptr, queue.counter, queue.skip != nullptr};
    std::vector<Binding> bindings = with_surfaces(rays.surfaces);
    bindings.push_back({"rays", queue.rays});
    bindings.push_back(Binding::if_used("skip", queue.skip));
    bindings.push_back(Binding::if_used("queue", queue.counters));
    bindings.push_back({"hits", rays.hits});
    bindings.push_back({"media", rays.media});
    bindings.push_back({"media_walls", rays.walls});
    record_khr_rays(commands, device_, pass, khr_bindings(structures_, bindings), p, queue);
}

void KhrTracer::shadow(Commands& commands, const ShadowRays& shadows) {
    const RayPass& pass = khr_pass(device_,
                                   shadows.media   ? "trace_shadow_khr_media"
                                   : shadows.glass ? "trace_shadow_khr_glass"
                                                   : "trace_shadow_khr",
                                   shadows.glass ? KhrRays::nearest_to_light : KhrRays::occluded, triangles_,
                                   shadows.glass ? Constants{shadows.materials} : Constants{});
    std::vector<Binding> bindings = with_surfaces(shadows.surfaces);
    bindings.push_back(Binding::if_used("shadow_media", shadows.media));
    bindings.push_back({"shadow_rays", shadows.rays.rays});
    bindings.push_back(Binding::if_used("shadow_skip", *shadows.rays.skip));
    bindings.push_back({"shadow_light", shadows.light});
    bindings.push_back({"queue", *shadows.rays.counters});
    record_khr_rays(commands, device_, pass, khr_bindings(structures_, bindings), shadows.rays.count, shadows.rays);
}

void KhrTracer::describe(Commands&, TracerStats& stats, bool) const {
    stats.structures = structures_.stats();
    stats.update = update_;
}

}  // namespace peelray
