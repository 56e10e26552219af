#include "ldc/tracer.h"

#include <cassert>

namespace peelray {

std::vector<Binding> cube_bindings(const TracedScene& scene, std::initializer_list<Binding> others) {
    std::vector<Binding> bindings = {{"top_table", scene.cubes.top_table},
                                     {"node_table", scene.cubes.node_table},
                                     {"voxel_table", scene.cubes.voxel_table},
                                     {"samples", scene.cubes.samples},
                                     {"sample_ids", scene.cubes.sample_ids},
                                     {"positions", scene.triangles.positions},
                                     {"triangles", scene.triangles.triangles},
                                     {"instances", scene.instances.table()},
                                     {"instance_boxes", scene.instances.boxes()},
                                     {"instance_cubes", scene.instances.cubes()}};
    for (const Binding& other : others) bindings.push_back(other);
    return bindings;
}

void record_trace(Commands& commands, Device& device, const TracedScene& scene, const RayQueue& queue,
                  const Buffer& hits, HitTest test, bool any_hit, Edges edges) {
    assert(scene.cubes.sampling() == sampling_for(test));
    const Pass& pass =
        device.pass("trace", {any_hit, test == HitTest::planar, edges == Edges::precise && test == HitTest::exact,
                              scene.triangles.masks && test == HitTest::exact});
    TraceParams p{};
    p.tree = scene.instances.tree();
    p.count = queue.count;
    p.counted = queue.counters != nullptr;
    p.counter = queue.counter;
    p.skips = queue.skip != nullptr;
    std::vector<Binding> bindings =
        cube_bindings(scene, {{"rays", queue.rays},
                              {"skip", queue.skip ? *queue.skip : queue.rays},
                              {"queue", queue.counters ? *queue.counters : queue.rays},
                              {"hits", hits}});
    for (const Binding& binding : alpha_bindings(scene.triangles)) bindings.push_back(binding);
    if (queue.groups) {
        commands.run_indirect(pass, bindings, p, *queue.groups, queue.groups_offset);
        return;
    }
    commands.run(pass, bindings, p, groups_for(queue.count, 64));
}

void record_file_hits(Commands& commands, Device& device, const Instances& instances, const Buffer& triangle_ids,
                      const Buffer& hits, uint32_t count, const Buffer& file_hits) {
    commands.run(device.pass("file_hits"),
                 {{"hits", hits},
                  {"instances", instances.table()},
                  {"triangle_ids", triangle_ids},
                  {"file_hits", file_hits}},
                 count, groups_for(count, 64));
}

}  // namespace peelray
