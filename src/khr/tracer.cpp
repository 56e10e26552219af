#include "khr/tracer.h"

namespace peelray {

const RayPass& khr_pass(Device& device, std::string_view shader, KhrRays rays, bool masked, Constants constants) {
    RaySetup setup;
    setup.rays = rays == KhrRays::nearest ? "khr_nearest" : "khr_occluded";
    setup.nearest = rays == KhrRays::nearest;
    // Nearest hits are asked about where a ray meets the triangle that it leaves, too.
    setup.any = rays == KhrRays::nearest || masked;
    setup.constants = std::move(constants);
    if (setup.nearest) setup.constants.push_back({"masked", masked});
    return device.ray_pass(shader, setup);
}

std::vector<Binding> khr_bindings(const RayPass& pass, const Structures& structures,
                                  std::span<const Binding> bindings) {
    std::vector<Binding> all = {{"structures", structures.top()}, {"part_triangles", structures.part_triangles()}};
    all.insert(all.end(), bindings.begin(), bindings.end());
    return declared(pass, std::move(all));
}

void record_khr_trace(Commands& commands, Device& device, const Structures& structures,
                      const TriangleBuffers& triangles, const RayQueue& queue, const Buffer& hits, bool any_hit) {
    const RayPass& pass =
        khr_pass(device, "trace_khr", KhrRays::nearest, triangles.masks != nullptr, {{"any_hit", any_hit}});
    const KhrTraceParams p{queue.count, queue.counters != nullptr, queue.counter, queue.skip != nullptr};
    const Binding bindings[] = {{"rays", queue.rays},
                                {"skip", queue.skip ? *queue.skip : queue.rays},
                                {"queue", queue.counters ? *queue.counters : queue.rays},
                                {"hits", hits},
                                {"triangles", triangles.triangles}};
    record_khr_rays(commands, device, pass, khr_bindings(pass, structures, with_alpha_test(bindings, triangles)), p,
                    queue);
}

}  // namespace peelray
