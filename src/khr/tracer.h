// Tracing queues of rays by the device's own ray tracing.
#pragma once

#include "khr/structures.h"
#include "ldc/tracer.h"

namespace peelray {

/// Records the tracing of a queue, into hits (Hit each), with the meaning of ldc's record_trace: the same t, triangles
/// and instances, the same rays that are none. `any_hit`: some hit instead of the nearest.
void record_khr_trace(Commands& commands, Device& device, const Structures& structures,
                      const TriangleBuffers& triangles, const RayQueue& queue, const Buffer& hits, bool any_hit);

/// The shaders of rays that start in a pass of `shader`s kind: what hits mean is decided there.
enum class KhrRays : uint8_t {
    nearest,           ///< look for the nearest hit, or for some
    nearest_to_light,  ///< the same, from a surface to a light
    occluded,          ///< ask whether there is anything between a surface and a light
};

/// The pass NAME.rgen for these rays. `constants`: its own, beside those of the shaders of hits.
const RayPass& khr_pass(Device& device, std::string_view shader, KhrRays rays, const TriangleBuffers& triangles,
                        Constants constants = {});

/// `bindings`, and the structures.
std::vector<Binding> khr_bindings(const Structures& structures, std::span<const Binding> bindings);

/// Records a pass of rays for as many as are in the queue.
template <typename Params>
void record_khr_rays(Commands& commands, Device& device, const RayPass& pass, std::span<const Binding> bindings,
                     const Params& params, const RayQueue& queue) {
    if (queue.groups && device.features.indirect_rays)
        commands.trace_indirect(pass, bindings, params, *queue.groups, queue.launch_offset);
    else
        commands.trace(pass, bindings, params, queue.count);
}

}  // namespace peelray
