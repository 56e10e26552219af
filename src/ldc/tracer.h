// Tracing queues of rays in cubes.
#pragma once

#include <optional>

#include "gpu/commands.h"
#include "ldc/cubes.h"
#include "ldc/instances.h"
#include "ldc/trace_params.h"

namespace peelray {

static_assert(unsigned(HitTest::exact) == PEELRAY_EXACT && unsigned(HitTest::planar) == PEELRAY_PLANAR &&
              unsigned(HitTest::tolerance) == PEELRAY_TOLERANCE);

/// What rays are traced in: all of a scene's cubes, placed in the world.
struct TracedScene {
    const Cubes& cubes;
    const Instances& instances;
    const TriangleBuffers& triangles;
    /// Of triangles from `first_copy` on: uvec2 each, the instance and the triangle that they are a copy of
    /// (Instances::merge). Null: none are.
    const Buffer* copied = nullptr;
    uint32_t first_copy = 0;
};

/// Where it is counted what rays cost (shaders/counting.glsl); both are added to.
struct CountBuffers {
    const Buffer& costs;   ///< PeelrayCounts of each entry of a queue
    const Buffer& totals;  ///< CountTotals of each kind of ray
};

/// A queue of rays on the device.
struct RayQueue {
    const Buffer& rays;            ///< Ray each
    const Buffer* skip = nullptr;  ///< SurfaceId per ray: a triangle that does not count; null: none
    uint32_t count;                ///< rays; with `counter`: room in the queue
    const Buffer* counters =
        nullptr;  ///< null: `count` rays; else the number is uint32 number `counter` of this buffer
    uint32_t counter = 0;
    const Buffer* groups =
        nullptr;  ///< null: dispatched for `count`; else workgroups of 64 rays are read at groups_offset
    uint64_t groups_offset = 0;
    uint64_t launch_offset = 0;  ///< of `groups`: the rays themselves (count, 1, 1), for the device's own ray tracing
    const CountBuffers* counting = nullptr;  ///< null: nothing is counted, and counting costs nothing
};

/// How `exact` hits within rounding of a triangle's edge are decided: both are watertight.
enum class Edges : uint8_t {
    single,   ///< in single precision: a few per million rays that graze a surface edge-on see its neighbour instead
    precise,  ///< in doubled precision: as a double-precision ray tracer sees them
};

/// The constants of the traversal, which all shaders have that trace one ray at a time (trace, trace_pixels,
/// trace_shadow*). `counting`: it is counted what rays cost.
Constants traversal_constants(const Device& device, const TracedScene& scene, HitTest test, bool counting);

/// The bindings of shaders/ldc/cube_fetch.glsl, and `others`.
std::vector<Binding> cube_bindings(const TracedScene& scene, std::initializer_list<Binding> others);

/// The parameters of a queue, but for `tolerance`.
TraceParams trace_params(const TracedScene& scene, const RayQueue& queue);

struct TraceOptions {
    HitTest test = HitTest::exact;
    float tolerance = 0;   ///< of HitTest::tolerance, world units
    bool any_hit = false;  ///< some hit in (tmin, tmax), else the nearest
    Edges edges = Edges::precise;
};

/// Records the tracing of a queue: hits[i] (Hit each) for rays[i], as the cubes' layout says. The cubes must have been
/// sampled for the hit test (sampling_for); asserted.
void record_trace(Commands& commands, Device& device, const TracedScene& scene, const RayQueue& queue,
                  const Buffer& hits, const TraceOptions& options);

/// Records the translation of `count` hits into file_hits (FileHit each). `triangle_ids`: uint32 per triangle, its
/// place in the file less the instance's InstanceInfo::first_id.
void record_file_hits(Commands& commands, Device& device, const Instances& instances, const Buffer& triangle_ids,
                      const Buffer& hits, uint32_t count, const Buffer& file_hits);

/// The sampling that a hit test needs.
inline Sampling sampling_for(HitTest test) {
    switch (test) {
        case HitTest::exact:
            return Sampling::conservative;
        case HitTest::planar:
            return Sampling::band;
        case HitTest::tolerance:
            return Sampling::centre;
    }
    return Sampling::conservative;
}

}  // namespace peelray
