#include "ldc/voxel_order.h"

#include <algorithm>
#include <cstddef>

namespace peelray {
namespace {

/// Samples that the device binds at once, beside those of earlier builds; a fragment is no larger than what it becomes.
uint64_t most_samples(const BuildState& state) {
    const uint64_t bytes = std::max<uint64_t>(sizeof(LdcFragment), state.cubes.has_patches() ? 16 : 8);
    return left_of(state.most() / bytes, state.before.samples);
}

}  // namespace

/// A surface fills about two samples per pixel and LDI; what is too little is counted, grown and redone.
void VoxelOrder::guess(BuildState& state, const BuildSize& size) {
    LdcParams& p = state.params;
    p.cell_capacity = bounded(state, size.cells + size.cells / 8 + 8, 8);
    p.fragment_capacity = uint32_t(std::min(2 * size.pixels + 4 * size.triangles, most_samples(state)));
    p.node_capacity = bounded(state, size.pixels / 8 + 256, 256);
    p.occupied_capacity = bounded(state, std::min<uint64_t>(p.cell_capacity, size.pixels / 64 + 64), 256);
}

void VoxelOrder::allocate(Commands& commands, BuildState& state) {
    const LdcParams& p = state.params;
    const uint64_t cells = p.cell_capacity;
    state.cubes.reserve(commands,
                        state.before + TableSize{cells, p.occupied_capacity, p.node_capacity, p.fragment_capacity},
                        state.before);
    Device& device = state.device;
    ensure_size(device, state.node_masks, "node masks", cells * 8);
    ensure_size(device, occupancy_sums_, "occupancy sums", cells * 4);
    ensure_size(device, top_cells_, "occupied cells", uint64_t(p.occupied_capacity) * 8);
    ensure_size(device, node_cells_, "occupied nodes", uint64_t(p.node_capacity) * 8);
    ensure_size(device, voxel_counts_, "voxel counts", uint64_t(p.node_capacity) * 256);
}

void VoxelOrder::clear(Commands& commands, const BuildState& state) {
    commands.fill(state.node_masks, 0, 0, uint64_t(state.params.cell_capacity) * 8);
    commands.fill(voxel_counts_, 0, 0, uint64_t(state.params.node_capacity) * 256);
}

/// All passes are dispatched for what there is room for, which is little more than what there is (settle): that costs
/// less than waiting until the GPU has counted. The sums for the boxes have nothing to do with the lists: they are
/// recorded between the lists' passes, where the GPU has room for both.
void VoxelOrder::record(Commands& commands, const BuildState& state, const TriangleBuffers& triangles) {
    const LdcParams& p = state.params;
    if (state.cubes.has_patches() && state.cubes.layout().builder != BuilderKind::compute)
        commands.run(state.device.pass("ldc_corners"),
                     {{"positions", triangles.positions},
                      {"triangles", triangles.triangles},
                      {"bodies", state.cubes.table.entries},
                      {"corners", state.cubes.corners}},
                     state.params, groups_for(state.params.triangles, 128));
    record_nodes(commands, state);
    record_sums(commands, state, 0);
    commands.run(state.device.pass("ldc_count"),
                 {{"counters", state.counters},
                  {"top_table", state.cubes.top_table},
                  {"node_table", state.cubes.node_table},
                  {"fragments", state.fragments},
                  {"voxel_counts", voxel_counts_}},
                 state.params, groups_for(p.fragment_capacity, 128));
    record_sums(commands, state, 1);
    commands.run(
        state.device.pass("ldc_voxels"),
        {{"counters", state.counters}, {"voxel_counts", voxel_counts_}, {"voxel_table", state.cubes.voxel_table}},
        state.params, groups_for(p.node_capacity, 4));
    record_sums(commands, state, 2);
    commands.run(state.device.pass("ldc_scatter"),
                 {{"counters", state.counters},
                  {"voxel_table", state.cubes.voxel_table},
                  {"fragments", state.fragments},
                  {"voxel_counts", voxel_counts_},
                  {"node_cells", node_cells_},
                  {"positions", triangles.positions},
                  {"triangles", triangles.triangles},
                  Binding::if_used("samples", state.cubes.samples),
                  Binding::if_used("sample_ids", state.cubes.sample_ids),
                  Binding::if_used("patches", state.cubes.patches),
                  Binding::if_used("corners", state.cubes.corners),
                  {"bodies", state.cubes.table.entries}},
                 state.params, groups_for(p.fragment_capacity, 128));
    commands.run(state.device.pass("ldc_top_boxes"),
                 {{"node_masks", state.node_masks},
                  {"occupancy_sums", occupancy_sums_},
                  {"top_table", state.cubes.top_table},
                  {"bodies", state.cubes.table.entries},
                  {"counters", state.counters},
                  {"readback", state.readback}},
                 state.params, groups_for(p.cell_capacity, 64));
}

/// The tables down to the nodes.
void VoxelOrder::record_nodes(Commands& commands, const BuildState& state) {
    const LdcParams& p = state.params;
    commands.run(state.device.pass("ldc_tops"),
                 {{"node_masks", state.node_masks},
                  {"top_table", state.cubes.top_table},
                  {"top_cells", top_cells_},
                  {"counters", state.counters}},
                 p, groups_for(p.cell_capacity, 256));
    commands.run(state.device.pass("ldc_nodes"),
                 {{"counters", state.counters},
                  {"node_masks", state.node_masks},
                  {"top_cells", top_cells_},
                  {"node_table", state.cubes.node_table},
                  {"node_cells", node_cells_},
                  {"bodies", state.cubes.table.entries}},
                 p, groups_for(p.occupied_capacity, 1));
}

/// Prefix sums along an axis of the summed-volume table of occupied 16³ cells.
void VoxelOrder::record_sums(Commands& commands, const BuildState& state, uint32_t axis) {
    LdcParams p = state.params;
    p.axis = axis;
    commands.run(state.device.pass("ldc_sat_scan"),
                 {{"node_masks", state.node_masks},
                  {"occupancy_sums", occupancy_sums_},
                  {"bodies", state.cubes.table.entries},
                  {"counters", state.counters}},
                 p, groups_for(p.cell_capacity, 64));
}

// A stage that overflowed hides the needs of the later ones, which may ask for yet another turn; there are three
// stages.
bool VoxelOrder::grow(BuildState& state, const LdcCounters& counts) {
    LdcParams& p = state.params;
    const uint64_t most = state.most();
    bool grown = grow_capacity(p.cell_capacity, counts.cells, most / 8);
    // Of these the tables hold those of earlier builds as well.
    grown |= grow_capacity(p.fragment_capacity, counts.fragments, most_samples(state));
    grown |= grow_capacity(p.occupied_capacity, counts.occupied, left_of(most / 256, state.before.occupied));
    grown |= grow_capacity(p.node_capacity, counts.nodes, left_of(most / 256, state.before.nodes));
    return grown;
}

void VoxelOrder::settle(BuildState& state, const LdcCounters& counts) {
    LdcParams& p = state.params;
    settle_capacity(p.cell_capacity, counts.cells);
    settle_capacity(p.fragment_capacity, counts.fragments);
    settle_capacity(p.occupied_capacity, counts.occupied);
    settle_capacity(p.node_capacity, counts.nodes);
}

uint64_t VoxelOrder::bytes() const {
    uint64_t bytes = 0;
    for (const Buffer* buffer : {&top_cells_, &node_cells_, &voxel_counts_, &occupancy_sums_}) bytes += buffer->bytes();
    return bytes;
}

}  // namespace peelray
