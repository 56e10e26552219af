#include "ldc/tracer.h"

#include <cassert>

namespace peelray {

/// The tables of a cube, in either order: which there are depends on the layout.
static std::vector<Binding> table_bindings(const Cubes& cubes) {
    const bool by_pixel = cubes.layout().by_pixel();
    return {Binding::if_used("top_table", cubes.top_table),
            Binding::if_used("node_table", by_pixel ? cubes.pixel_offsets : cubes.node_table),
            Binding::if_used("voxel_table", by_pixel ? cubes.pixel_ranges : cubes.voxel_table),
            Binding::if_used("samples", cubes.samples),
            Binding::if_used("sample_ids", cubes.sample_ids),
            Binding::if_used("patches", cubes.patches),
            Binding::if_used("corners", cubes.corners)};
}

/// Those constants that the tracing of four rays by a thread has, too.
static Constants walk_constants(const TracedScene& scene, HitTest test, bool counting) {
    return {{"hit_test", uint32_t(test)},
            {"traversal", uint32_t(scene.cubes.layout().traversal)},
            {"masked", scene.triangles.masks && scene.cubes.tests_triangles()},
            {"single_sided", scene.triangles.sides != nullptr},
            {"counting", counting}};
}

Constants traversal_constants(const Device& device, const TracedScene& scene, HitTest test, bool counting) {
    Constants constants = walk_constants(scene, test, counting);
    const uint32_t instances = scene.instances.met();
    const bool counted = instances <= device.counted_instances;
    constants.push_back({"instance_count", counted ? instances : 0});
    const CubeLayout& layout = scene.cubes.layout();
    if (layout.by_pixel()) {
        constants.push_back({"batch", layout.batch == Batch::layers ? PEELRAY_FOUR_LAYERS : PEELRAY_ONE});
    } else {
        constants.push_back({"bare_count", counted ? scene.instances.bare(scene.cubes.table) : 0});
        constants.push_back({"deferred", device.immediate});
        constants.push_back({"refined", scene.cubes.refined});
        constants.push_back({"merging", scene.copied != nullptr});
    }
    return constants;
}

std::vector<Binding> cube_bindings(const TracedScene& scene, std::initializer_list<Binding> others) {
    std::vector<Binding> bindings = {{"positions", scene.triangles.positions},
                                     {"triangles", scene.triangles.triangles},
                                     Binding::if_used("instances", scene.instances.table()),
                                     Binding::if_used("instance_boxes", scene.instances.boxes()),
                                     {"instance_cubes", scene.instances.cubes()},
                                     Binding::if_used("copied", scene.copied)};
    for (const Binding& table : table_bindings(scene.cubes)) bindings.push_back(table);
    for (const Binding& other : others) bindings.push_back(other);
    return bindings;
}

TraceParams trace_params(const TracedScene& scene, const RayQueue& queue) {
    TraceParams p{};
    p.tree = scene.instances.tree();
    p.count = queue.count;
    p.counted = queue.counters != nullptr;
    p.counter = queue.counter;
    p.skips = queue.skip != nullptr;
    p.block = scene.cubes.layout().block;
    p.merged_instance = scene.instances.count();
    p.first_copy = scene.first_copy;
    return p;
}

void record_trace(Commands& commands, Device& device, const TracedScene& scene, const RayQueue& queue,
                  const Buffer& hits, const TraceOptions& options) {
    const HitTest test = options.test;
    assert(scene.cubes.sampling() == sampling_for(test));
    const CubeLayout& layout = scene.cubes.layout();
    const bool four = layout.by_pixel() && layout.batch == Batch::rays, counting = queue.counting != nullptr;
    Constants constants =
        four ? walk_constants(scene, test, counting) : traversal_constants(device, scene, test, counting);
    constants.push_back({"any_hit", options.any_hit});
    constants.push_back({"precise_edges", options.edges == Edges::precise && test == HitTest::exact});
    const Pass& pass = device.pass(four ? "trace_four" : layout.by_pixel() ? "trace_pixels" : "trace", constants);
    TraceParams p = trace_params(scene, queue);
    p.tolerance = options.tolerance;
    std::vector<Binding> bindings =
        cube_bindings(scene, {{"rays", queue.rays},
                              Binding::if_used("skip", queue.skip),
                              Binding::if_used("queue", queue.counters),
                              {"hits", hits},
                              Binding::if_used("costs", counting ? &queue.counting->costs : nullptr),
                              Binding::if_used("count_totals", counting ? &queue.counting->totals : nullptr)});
    bindings = with_hit_materials(bindings, scene.triangles);
    if (queue.groups) {
        commands.run_indirect(pass, bindings, p, *queue.groups, queue.groups_offset);
        return;
    }
    commands.run(pass, bindings, p, groups_for(four ? (queue.count + 3) / 4 : queue.count, 64));
}

void record_file_hits(Commands& commands, Device& device, const Instances& instances, const Buffer& triangle_ids,
                      const Buffer& hits, uint32_t count, const Buffer& file_hits) {
    commands.run(
        device.pass("file_hits"),
        {{"hits", hits}, {"instances", instances.table()}, {"triangle_ids", triangle_ids}, {"file_hits", file_hits}},
        count, groups_for(count, 64));
}

}  // namespace peelray
