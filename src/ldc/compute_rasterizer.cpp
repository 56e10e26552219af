#include "ldc/compute_rasterizer.h"

namespace peelray {

/// Pixels of a triangle's bounds that one thread goes through: fewer where there are too few triangles to fill a GPU.
static uint32_t small_pixels(uint32_t triangles) {
    return triangles < 100'000 ? 12 : 48;
}

void ComputeRasterizer::guess(BuildState& state, const BuildSize& size) {
    state.params.block_capacity = bounded(state, size.pixels / 64 + 4096, 8);
}

void ComputeRasterizer::allocate(Commands&, BuildState& state) {
    ensure_size(state.device, blocks_, "queue of blocks", uint64_t(state.params.block_capacity) * 8);
}

void ComputeRasterizer::record(Commands& commands, const BuildState& state, const TriangleBuffers& triangles) {
    Device& device = state.device;
    const LdcParams& p = state.params;
    const bool masked = state.tests_alpha(triangles);
    const Binding geometry[] = {{"positions", triangles.positions},
                                {"triangles", triangles.triangles},
                                {"counters", state.counters},
                                {"node_masks", state.node_masks},
                                {"fragments", state.fragments},
                                {"bodies", state.cubes.body_table},
                                {"blocks", blocks_}};
    const std::vector<Binding> bindings = with_alpha_test(geometry, triangles);
    commands.run(device.pass("ldc_raster", {masked, small_pixels(p.triangles)}), bindings, p,
                 groups_for(p.triangles, 128));
    state.record_groups(commands);
    commands.run_indirect(device.pass("ldc_raster_blocks", {masked}), bindings, p, state.groups,
                          LDC_GROUPS_BLOCKS * 12);
}

bool ComputeRasterizer::grow(BuildState& state, const LdcCounters& counts) {
    return grow_capacity(state.params.block_capacity, counts.blocks, state.most() / 8);
}

}  // namespace peelray
