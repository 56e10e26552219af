#include "ldc/tracer.h"

#include <cassert>

namespace peelray {

void record_trace(Commands& commands, Device& device, const Cube& cube, const TriangleBuffers& triangles,
                  const RayQueue& queue, const Buffer& hits, HitTest test, bool any_hit, Edges edges) {
    assert(cube.sampling == sampling_for(test));
    const Pass& pass =
        device.pass("trace", {any_hit, test == HitTest::planar, edges == Edges::precise && test == HitTest::exact});
    TraceParams p{};
    p.grid = cube.grid;
    p.count = queue.count;
    p.counted = queue.counters != nullptr;
    p.counter = queue.counter;
    p.skips = queue.skip != nullptr;
    const std::initializer_list<Binding> bindings = {{"top_table", cube.top_table},
                                                     {"node_table", cube.node_table},
                                                     {"voxel_table", cube.voxel_table},
                                                     {"samples", cube.samples},
                                                     {"sample_ids", cube.sample_ids},
                                                     {"positions", triangles.positions},
                                                     {"triangles", triangles.triangles},
                                                     {"rays", queue.rays},
                                                     {"skip", queue.skip ? *queue.skip : queue.rays},
                                                     {"queue", queue.counters ? *queue.counters : queue.rays},
                                                     {"hits", hits}};
    if (queue.groups) {
        commands.run_indirect(pass, bindings, p, *queue.groups, queue.groups_offset);
        return;
    }
    commands.run(pass, bindings, p, groups_for(queue.count, 64));
}

}  // namespace peelray
