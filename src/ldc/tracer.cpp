#include "ldc/tracer.h"

#include <cassert>

namespace peelray {

std::vector<Binding> sample_bindings(const Cubes& cubes, const Buffer& absent, std::span<const Binding> others) {
    const bool by_pixel = cubes.layout().by_pixel();
    const auto or_absent = [&](const Buffer& buffer) -> const Buffer& { return buffer ? buffer : absent; };
    std::vector<Binding> bindings = {{"top_table", or_absent(cubes.top_table)},
                                     {"node_table", or_absent(by_pixel ? cubes.pixel_offsets : cubes.node_table)},
                                     {"voxel_table", or_absent(by_pixel ? cubes.pixel_ranges : cubes.voxel_table)},
                                     {"samples", or_absent(cubes.samples)},
                                     {"sample_ids", or_absent(cubes.sample_ids)},
                                     {"patches", or_absent(cubes.patches)},
                                     {"corners", or_absent(cubes.corners)}};
    for (const Binding& other : others) bindings.push_back(other);
    return bindings;
}

/// Those constants that the tracing of four rays by a thread has, too.
static Constants walk_constants(const TracedScene& scene, HitTest test, bool counting) {
    return {{"hit_test", uint32_t(test)},
            {"traversal", uint32_t(scene.cubes.layout().traversal)},
            {"masked", scene.triangles.masks && scene.cubes.tests_triangles()},
            {"counting", counting}};
}

Constants traversal_constants(const Device& device, const TracedScene& scene, HitTest test, bool counting) {
    Constants constants = walk_constants(scene, test, counting);
    const uint32_t instances = scene.instances.count();
    constants.push_back({"instance_count", instances <= 8 ? instances : 0});
    const CubeLayout& layout = scene.cubes.layout();
    if (layout.by_pixel()) {
        constants.push_back({"batch", layout.batch == Batch::layers ? PEELRAY_FOUR_LAYERS : PEELRAY_ONE});
    } else {
        constants.push_back({"bare_count", scene.instances.bare(scene.cubes)});
        constants.push_back({"deferred", device.immediate});
    }
    return constants;
}

std::vector<Binding> cube_bindings(const TracedScene& scene, std::initializer_list<Binding> others) {
    std::vector<Binding> bindings = {{"positions", scene.triangles.positions},
                                     {"triangles", scene.triangles.triangles},
                                     {"instances", scene.instances.table()},
                                     {"instance_boxes", scene.instances.boxes()},
                                     {"instance_cubes", scene.instances.cubes()}};
    for (const Binding& other : others) bindings.push_back(other);
    return sample_bindings(scene.cubes, scene.cubes.body_table, bindings);
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
    TraceParams p{};
    p.tree = scene.instances.tree();
    p.count = queue.count;
    p.counted = queue.counters != nullptr;
    p.counter = queue.counter;
    p.skips = queue.skip != nullptr;
    p.tolerance = options.tolerance;
    p.block = scene.cubes.layout().block;
    std::vector<Binding> bindings =
        cube_bindings(scene, {{"rays", queue.rays},
                              {"skip", queue.skip ? *queue.skip : queue.rays},
                              {"queue", queue.counters ? *queue.counters : queue.rays},
                              {"hits", hits},
                              {"costs", queue.counting ? queue.counting->costs : hits},
                              {"count_totals", queue.counting ? queue.counting->totals : hits}});
    bindings = declared(pass, with_alpha_test(bindings, scene.triangles));
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
