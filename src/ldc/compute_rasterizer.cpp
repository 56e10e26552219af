#include "ldc/compute_rasterizer.h"

namespace peelray {

void ComputeRasterizer::guess(BuildState& state, const BuildSize& size) {
    state.params.big_capacity = bounded(state, 4096, 4);
    state.params.tile_capacity = bounded(state, size.pixels / 64 + 4096, 8);
}

void ComputeRasterizer::allocate(Commands&, BuildState& state) {
    ensure_size(state.device, big_triangles_, "queue of large triangles", uint64_t(state.params.big_capacity) * 4);
    ensure_size(state.device, tiles_, "queue of tiles", uint64_t(state.params.tile_capacity) * 8);
}

void ComputeRasterizer::record(Commands& commands, const BuildState& state, const TriangleBuffers& triangles) {
    Device& device = state.device;
    const LdcParams& p = state.params;
    const bool masked = state.tests_alpha(triangles);
    const Binding geometry[] = {{"positions", triangles.positions}, {"triangles", triangles.triangles},
                                {"counters", state.counters},       {"node_masks", state.node_masks},
                                {"fragments", state.fragments},     {"bodies", state.cubes.body_table}};
    std::vector<Binding> bindings = with_alpha_test(geometry, triangles);
    bindings.push_back({"big_triangles", big_triangles_});
    commands.run(device.pass("ldc_raster", {masked}), bindings, p, groups_for(p.triangles, 64));
    state.record_groups(commands);
    commands.run_indirect(device.pass("ldc_tiles"),
                          {{"positions", triangles.positions},
                           {"triangles", triangles.triangles},
                           {"counters", state.counters},
                           {"big_triangles", big_triangles_},
                           {"tiles", tiles_},
                           {"bodies", state.cubes.body_table}},
                          p, state.groups, LDC_GROUPS_BIG * 12);
    state.record_groups(commands);
    bindings.pop_back();
    bindings.push_back({"tiles", tiles_});
    commands.run_indirect(device.pass("ldc_raster_tiles", {masked}), bindings, p, state.groups, LDC_GROUPS_TILES * 12);
}

bool ComputeRasterizer::grow(BuildState& state, const LdcCounters& counts) {
    const bool big = grow_capacity(state.params.big_capacity, counts.big, state.most() / 4);
    return grow_capacity(state.params.tile_capacity, counts.tiles, state.most() / 8) || big;
}

}  // namespace peelray
