#include "ldc/compute_rasterizer.h"

#include <algorithm>

namespace peelray {

/// Up to so many triangles do not fill a GPU with a thread each: then the pixels of a workgroup's are shared by four
/// threads for each.
constexpr uint32_t kFewTriangles = 150'000;
/// Most pixels of a small triangle's bounds; a larger one is cut into blocks.
constexpr uint32_t kSmallPixels = 48;

void ComputeRasterizer::guess(BuildState& state, const BuildSize& size) {
    state.params.block_capacity = bounded(state, size.pixels / 64 + 4096, 8);
}

void ComputeRasterizer::allocate(Commands&, BuildState& state) {
    ensure_size(state.device, blocks_, "queue of blocks", std::max(state.params.block_capacity, 1u) * 8ull);
}

void ComputeRasterizer::record(Commands& commands, const BuildState& state, const TriangleBuffers& triangles) {
    Device& device = state.device;
    const LdcParams& p = state.params;
    const bool masked = state.tests_alpha(triangles);
    const bool corners = state.cubes.has_patches();
    const Binding geometry[] = {{"positions", triangles.positions},
                                {"triangles", triangles.triangles},
                                {"counters", state.counters},
                                {"node_masks", state.node_masks},
                                {"fragments", state.fragments},
                                {"bodies", state.cubes.table.entries},
                                {"blocks", blocks_},
                                Binding::if_used("corners", corners ? &state.cubes.corners : nullptr)};
    const std::vector<Binding> bindings = with_hit_materials(geometry, triangles);
    commands.run(device.pass(p.triangles <= kFewTriangles ? "ldc_raster_few" : "ldc_raster",
                             {{"masked", masked}, {"small_pixels", kSmallPixels}, {"keeps_corners", corners}}),
                 bindings, p, groups_for(p.triangles, 64));
    if (p.block_capacity == 0) return;
    state.record_groups(commands);
    commands.run_indirect(device.pass("ldc_raster_blocks", {{"masked", masked}}), bindings, p, state.groups,
                          LDC_GROUPS_BLOCKS * 12);
}

/// Scenes without large triangles do without the passes for them.
void ComputeRasterizer::settle(BuildState& state, const BuildCounts& counts) {
    if (counts.blocks == 0) state.params.block_capacity = 0;
}

bool ComputeRasterizer::grow(BuildState& state, const BuildCounts& counts) {
    return grow_capacity(state.params.block_capacity, counts.blocks, state.most() / 8);
}

}  // namespace peelray
