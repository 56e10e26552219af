#include "khr/tracer.h"
#include "khr/khr_params.h"

namespace peelray {

const RayPass& khr_pass(Device& device, std::string_view shader, KhrRays rays, const TriangleBuffers& triangles,
                        Constants constants) {
    const bool masked = triangles.masks != nullptr, single_sided = triangles.sides != nullptr;
    RaySetup setup;
    setup.nearest = rays != KhrRays::occluded;
    setup.rays = setup.nearest ? "khr_nearest" : "khr_occluded";
    // Nearest hits are asked about where a ray meets the triangle that it leaves, too.
    setup.any = setup.nearest || masked || single_sided;
    setup.constants = std::move(constants);
    if (setup.nearest) {
        setup.constants.push_back({"masked", masked});
        setup.constants.push_back({"single_sided", single_sided});
        setup.constants.push_back({"to_light", rays == KhrRays::nearest_to_light});
    }
    return device.ray_pass(shader, setup);
}

std::vector<Binding> khr_bindings(const Structures& structures, std::span<const Binding> bindings) {
    std::vector<Binding> all = {{"structures", structures.top()},
                                Binding::if_used("part_triangles", structures.part_triangles())};
    all.insert(all.end(), bindings.begin(), bindings.end());
    return all;
}

void record_khr_trace(Commands& commands, Device& device, const Structures& structures,
                      const TriangleBuffers& triangles, const RayQueue& queue, const Buffer& hits, bool any_hit) {
    const RayPass& pass = khr_pass(device, "trace_khr", KhrRays::nearest, triangles, {{"any_hit", any_hit}});
    const KhrTraceParams p{queue.count, queue.counters != nullptr, queue.counter, queue.skip != nullptr};
    const Binding bindings[] = {{"rays", queue.rays},
                                Binding::if_used("skip", queue.skip),
                                Binding::if_used("queue", queue.counters),
                                {"hits", hits},
                                Binding::if_used("positions", triangles.positions),
                                Binding::if_used("triangles", triangles.triangles)};
    record_khr_rays(commands, device, pass, khr_bindings(structures, with_hit_materials(bindings, triangles)), p,
                    queue);
}

}  // namespace peelray
