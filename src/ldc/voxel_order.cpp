#include "ldc/voxel_order.h"

#include <algorithm>
#include <cstddef>
#include <cstring>

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
    p.refine_above = state.refinement.above;
    p.refine_from = state.refinement.from;
    p.refine_most = state.refinement.most;
}

void VoxelOrder::allocate(Commands& commands, BuildState& state) {
    const LdcParams& p = state.params;
    const uint64_t cells = p.cell_capacity;
    state.cubes.reserve(
        commands,
        state.before + TableSize{cells, p.occupied_capacity, p.node_capacity + uint64_t(p.refine_capacity),
                                 uint64_t(p.fragment_capacity) + p.fine_capacity},
        state.before);
    Device& device = state.device;
    ensure_size(device, state.node_masks, "node masks", cells * 8);
    ensure_size(device, occupancy_sums_, "occupancy sums", cells * 4);
    ensure_size(device, top_cells_, "occupied cells", uint64_t(p.occupied_capacity) * 8);
    ensure_size(device, node_cells_, "occupied nodes", uint64_t(p.node_capacity) * 8);
    ensure_size(device, voxel_counts_, "voxel counts", uint64_t(p.node_capacity) * 256);
    if (p.refine_capacity == 0) return;
    ensure_size(device, refine_queue_, "queue of lists to refine", uint64_t(p.refine_capacity) * 4);
    ensure_size(device, refined_, "refined lists", sizeof(LdcRefined));
    if (!refined_readback_)
        refined_readback_ = Buffer(device, "refined lists readback", sizeof(LdcRefined), Buffer::Where::readback);
    state.cubes.refined = true;
}

void VoxelOrder::clear(Commands& commands, const BuildState& state) {
    commands.fill(state.node_masks, 0, 0, uint64_t(state.params.cell_capacity) * 8);
    commands.fill(voxel_counts_, 0, 0, uint64_t(state.params.node_capacity) * 256);
    if (state.params.refine_capacity != 0) commands.fill(refined_, 0);
}

/// All passes are dispatched for what there is room for, which is little more than what there is (settle): that costs
/// less than waiting until the GPU has counted. The boxes of the top table and what they need have nothing to do with
/// the lists: they are recorded behind the lists' passes, each beside one that it does not touch.
void VoxelOrder::record(Commands& commands, const BuildState& state, const TriangleBuffers& triangles) {
    const LdcParams& p = state.params;
    if (state.cubes.has_patches() && state.cubes.layout().builder != BuilderKind::compute)
        commands.run(state.device.pass("ldc_corners"),
                     {{"positions", triangles.positions},
                      {"triangles", triangles.triangles},
                      {"bodies", state.cubes.table.entries},
                      {"corners", state.cubes.corners}},
                     p, groups_for(p.triangles, 128));
    record_tops(commands, state);
    record_sums(commands, state, 0);
    record_nodes(commands, state);
    record_sums(commands, state, 1);
    commands.run(state.device.pass("ldc_count"),
                 {{"counters", state.counters},
                  {"top_table", state.cubes.top_table},
                  {"node_table", state.cubes.node_table},
                  {"fragments", state.fragments},
                  {"voxel_counts", voxel_counts_}},
                 p, groups_for(p.fragment_capacity, 128));
    record_sums(commands, state, 2);
    commands.run(state.device.pass("ldc_voxels"),
                 {{"counters", state.counters},
                  {"voxel_counts", voxel_counts_},
                  {"voxel_table", state.cubes.voxel_table},
                  Binding::if_used("refine_queue", refine_queue_)},
                 p, groups_for(p.node_capacity, 4));
    commands.run(state.device.pass("ldc_top_boxes"),
                 {{"node_masks", state.node_masks},
                  {"occupancy_sums", occupancy_sums_},
                  {"top_table", state.cubes.top_table},
                  {"bodies", state.cubes.table.entries},
                  {"extent", state.extent}},
                 p, groups_for(p.cell_capacity, 64));
    // It leaves the counters for the host, so that it runs where there are no samples as well.
    commands.run(state.device.pass("ldc_scatter"),
                 {{"counters", state.counters},
                  {"voxel_table", state.cubes.voxel_table},
                  {"fragments", state.fragments},
                  {"voxel_counts", voxel_counts_},
                  {"node_cells", node_cells_},
                  {"positions", triangles.positions},
                  {"triangles", triangles.triangles},
                  {"readback", state.readback},
                  Binding::if_used("samples", state.cubes.samples),
                  Binding::if_used("sample_ids", state.cubes.sample_ids),
                  Binding::if_used("patches", state.cubes.patches),
                  Binding::if_used("corners", state.cubes.corners),
                  {"bodies", state.cubes.table.entries}},
                 p, groups_for(std::max(p.fragment_capacity, 1u), 128));
    if (p.refine_capacity != 0) record_refinement(commands, state);
}

void VoxelOrder::record_tops(Commands& commands, const BuildState& state) {
    const LdcParams& p = state.params;
    commands.run(state.device.pass("ldc_tops"),
                 {{"node_masks", state.node_masks},
                  {"top_table", state.cubes.top_table},
                  {"top_cells", top_cells_},
                  {"counters", state.counters}},
                 p, groups_for(p.cell_capacity, 256));
}

void VoxelOrder::record_nodes(Commands& commands, const BuildState& state) {
    const LdcParams& p = state.params;
    commands.run(state.device.pass("ldc_nodes"),
                 {{"counters", state.counters},
                  {"node_masks", state.node_masks},
                  {"top_cells", top_cells_},
                  {"node_table", state.cubes.node_table},
                  {"node_cells", node_cells_},
                  {"bodies", state.cubes.table.entries}},
                 p, groups_for(p.occupied_capacity, 1));
}

/// Finer voxels where lists are long.
void VoxelOrder::record_refinement(Commands& commands, const BuildState& state) {
    commands.run(state.device.pass("ldc_refine"),
                 {{"counters", state.counters},
                  {"voxel_table", state.cubes.voxel_table},
                  {"voxel_counts", voxel_counts_},
                  {"node_cells", node_cells_},
                  {"patches", state.cubes.patches},
                  {"corners", state.cubes.corners},
                  {"bodies", state.cubes.table.entries},
                  {"refine_queue", refine_queue_},
                  {"refined", refined_}},
                 state.params, groups_for(state.params.refine_capacity, 1));
    commands.copy(refined_, refined_readback_, sizeof(LdcRefined));
}

/// Prefix sums along an axis of the summed-volume table of occupied 16³ cells.
void VoxelOrder::record_sums(Commands& commands, const BuildState& state, uint32_t axis) {
    LdcParams p = state.params;
    p.axis = axis;
    commands.run(state.device.pass("ldc_sat_scan"),
                 {{"node_masks", state.node_masks},
                  {"occupancy_sums", occupancy_sums_},
                  {"bodies", state.cubes.table.entries},
                  {"extent", state.extent}},
                 p, groups_for(p.cell_capacity, 64));
}

void VoxelOrder::read(const BuildState& state, BuildCounts& counts) const {
    if (counts.longest <= state.params.refine_from || counts.refine > state.params.refine_most) counts.refine = 0;
    if (counts.refine == 0 || !refined_readback_) return;
    LdcRefined refined;
    std::memcpy(&refined, refined_readback_.mapped(), sizeof refined);
    counts.refined = refined.voxels;
    counts.fine = refined.samples;
    counts.longest = std::max(counts.longest_left, refined.longest);
}

// A stage that overflowed hides the needs of the later ones, which may ask for yet another turn; there are four
// stages.
bool VoxelOrder::grow(BuildState& state, const BuildCounts& counts) {
    LdcParams& p = state.params;
    const uint64_t most = state.most();
    bool grown = grow_capacity(p.cell_capacity, counts.cells, most / 8);
    // Of these the tables hold those of earlier builds as well.
    grown |= grow_capacity(p.fragment_capacity, counts.fragments, most_samples(state));
    grown |= grow_capacity(p.occupied_capacity, counts.occupied, left_of(most / 256, state.before.occupied));
    grown |= grow_capacity(p.node_capacity, counts.nodes, left_of(most / 256, state.before.nodes));
    if (grow_capacity(p.refine_capacity, counts.refine, most / 256)) {
        grown = true;
        // Not counted yet. A finer voxel holds a fifth of its voxel's list or so, and 20 of them hold something.
        p.fine_capacity = std::max(
            p.fine_capacity, uint32_t(std::min<uint64_t>(4ull * p.refine_above * counts.refine, most_samples(state))));
    }
    grown |= grow_capacity(p.fine_capacity, counts.fine, most_samples(state));
    return grown;
}

void VoxelOrder::settle(BuildState& state, const BuildCounts& counts) {
    LdcParams& p = state.params;
    settle_capacity(p.cell_capacity, counts.cells);
    settle_capacity(p.fragment_capacity, counts.fragments);
    settle_capacity(p.occupied_capacity, counts.occupied);
    settle_capacity(p.node_capacity, counts.nodes);
    settle_capacity(p.refine_capacity, counts.refine);
    settle_capacity(p.fine_capacity, counts.fine);
}

uint64_t VoxelOrder::bytes() const {
    uint64_t bytes = 0;
    for (const Buffer* buffer : {&top_cells_, &node_cells_, &voxel_counts_, &occupancy_sums_, &refine_queue_})
        bytes += buffer->bytes();
    return bytes;
}

}  // namespace peelray
