#include "ldc/compute_builder.h"

#include <algorithm>
#include <cstddef>
#include <cstring>

#include "base/error.h"

namespace peelray {
namespace {

/// llvmpipe stops a shader's loops after 65,535 iterations in all, silently, and a ray walks through lists sample by
/// sample. Measured: a list of 30,000 is traced right, one of 45,000 is not; a ray may meet several.
constexpr uint32_t kLongestListOnCpu = 16'000;

uint32_t with_reserve(uint32_t needed) {
    return uint32_t(std::min<uint64_t>(uint64_t(needed) * 3 / 2 + 64, 0x7fffffffu));
}

/// Grows `capacity` if `needed` exceeds it; tells whether it did.
bool grow_capacity(uint32_t& capacity, uint32_t needed, uint64_t most) {
    if (needed <= capacity) return false;
    // The reserve is a wish, the need is not: what exceeds the device's limit fails where memory is asked for.
    capacity = uint32_t(std::max<uint64_t>(needed, std::min<uint64_t>(with_reserve(needed), most)));
    return true;
}

}  // namespace

ComputeBuilder::ComputeBuilder(Device& device, Commands& commands, Cubes& cubes, uint32_t first, uint32_t bodies,
                               const TableSize& before)
    : device_(device), cubes_(cubes), first_(first), bodies_(bodies), before_(before) {
    counters_ = Buffer(device, "build counters", sizeof(LdcCounters));
    groups_ = Buffer(device, "build workgroups", LDC_GROUPS * 12);
    counters_readback_ = Buffer(device, "build counters readback", sizeof(LdcCounters), Buffer::Where::readback);
    guess_capacity();
    allocate(commands);
}

/// A surface fills about two samples per pixel and LDI; what is too little is counted, grown and redone.
void ComputeBuilder::guess_capacity() {
    uint64_t tops = 0, pixels = 0, triangles = 0;
    for (uint32_t i = first_; i < first_ + bodies_; i++) {
        const CubeBody& body = cubes_.bodies()[i];
        const glm::u64vec3 d = make_grid(body.lower, body.upper, body.resolution).dims;
        tops += d.x * d.y * d.z / 4096;
        pixels += d.x * d.y + d.y * d.z + d.z * d.x;
        triangles += body.triangles;
    }
    const uint64_t most = device_.limits().maxStorageBufferRange;
    const auto guess = [&](uint32_t& capacity, uint64_t count, uint64_t bytes_each) {
        capacity = uint32_t(std::min(count, most / bytes_each));
    };
    guess(capacity_.tops, tops + tops / 8 + 8, 8);
    guess(capacity_.fragments, 2 * pixels + 4 * triangles, sizeof(LdcFragment));
    guess(capacity_.nodes, pixels / 8 + 256, 256);
    guess(capacity_.occupied, std::min<uint64_t>(capacity_.tops, pixels / 64 + 64), 256);
    guess(capacity_.big, 4096, 4);
    guess(capacity_.tiles, pixels / 64 + 4096, 8);
    guess(capacity_.long_lists, 1024, 4);
}

void ComputeBuilder::allocate(Commands& commands) {
    const uint64_t tops = capacity_.tops, sums = std::max<uint64_t>(tops, capacity_.nodes);
    cubes_.reserve(commands, before_ + TableSize{tops, capacity_.occupied, capacity_.nodes, capacity_.fragments},
                   before_);
    ensure_size(device_, node_masks_, "node masks", tops * 8);
    ensure_size(device_, occupancy_sums_, "occupancy sums", tops * 4);
    ensure_size(device_, sums_, "prefix sums", sums * 8);
    ensure_size(device_, block_sums_, "prefix sums of blocks", (sums / SCAN_BLOCK + 2) * 8);
    ensure_size(device_, top_cells_, "occupied cells", uint64_t(capacity_.occupied) * 4);
    ensure_size(device_, node_cells_, "occupied nodes", uint64_t(capacity_.nodes) * 8);
    ensure_size(device_, voxel_counts_, "voxel counts", uint64_t(capacity_.nodes) * 256);
    ensure_size(device_, fragments_, "fragments", uint64_t(capacity_.fragments) * sizeof(LdcFragment));
    ensure_size(device_, unsorted_ids_, "unsorted samples", uint64_t(capacity_.fragments) * 4);
    ensure_size(device_, big_triangles_, "queue of large triangles", uint64_t(capacity_.big) * 4);
    ensure_size(device_, tiles_, "queue of tiles", uint64_t(capacity_.tiles) * 8);
    ensure_size(device_, long_lists_, "queue of long lists", uint64_t(capacity_.long_lists) * 4);
}

LdcParams ComputeBuilder::params() const {
    const CubeBody &first = cubes_.bodies()[first_], &last = cubes_.bodies()[first_ + bodies_ - 1];
    LdcParams p{};
    p.first_body = first_;
    p.bodies = bodies_;
    p.first_triangle = first.first_triangle;
    p.triangles = last.first_triangle + last.triangles - first.first_triangle;
    p.first_top = uint32_t(before_.tops);
    p.first_occupied = uint32_t(before_.occupied);
    p.first_node = uint32_t(before_.nodes);
    p.first_sample = uint32_t(before_.samples);
    p.planar = cubes_.sampling() == Sampling::centre;
    p.top_capacity = capacity_.tops;
    p.occupied_capacity = capacity_.occupied;
    p.node_capacity = capacity_.nodes;
    p.fragment_capacity = capacity_.fragments;
    p.big_capacity = capacity_.big;
    p.tile_capacity = capacity_.tiles;
    p.long_capacity = capacity_.long_lists;
    return p;
}

void ComputeBuilder::record_scan(Commands& commands, uint32_t capacity, uint32_t counter) {
    const ScanParams p{capacity, counter};
    const Groups groups = groups_for(capacity, SCAN_BLOCK);
    commands.run(device_.pass("scan_reduce"), {{"counters", counters_}, {"sums", sums_}, {"block_sums", block_sums_}},
                 p, groups);
    commands.run(device_.pass("scan_blocks"), {{"block_sums", block_sums_}}, p, {1});
    commands.run(device_.pass("scan_apply"), {{"counters", counters_}, {"sums", sums_}, {"block_sums", block_sums_}}, p,
                 groups);
}

void ComputeBuilder::record_groups(Commands& commands) {
    commands.run(device_.pass("ldc_groups"), {{"counters", counters_}, {"groups", groups_}}, params(), {1});
}

/// Fragments of all triangles, and the masks of the nodes that they touch.
void ComputeBuilder::record_raster(Commands& commands, const TriangleBuffers& triangles) {
    const LdcParams p = params();
    // Conservative samples keep what may be a hole: a hit decides at its own place.
    const bool masked = triangles.masks && cubes_.sampling() == Sampling::centre;
    std::vector<Binding> bindings = {
        {"positions", triangles.positions}, {"triangles", triangles.triangles}, {"counters", counters_},
        {"node_masks", node_masks_},        {"fragments", fragments_},          {"bodies", cubes_.body_table}};
    for (const Binding& binding : alpha_bindings(triangles)) bindings.push_back(binding);
    bindings.push_back({"big_triangles", big_triangles_});
    commands.run(device_.pass("ldc_raster", {masked}), bindings, p, groups_for(p.triangles, 64));
    record_groups(commands);
    commands.run_indirect(device_.pass("ldc_tiles"),
                          {{"positions", triangles.positions},
                           {"triangles", triangles.triangles},
                           {"counters", counters_},
                           {"big_triangles", big_triangles_},
                           {"tiles", tiles_},
                           {"bodies", cubes_.body_table}},
                          p, groups_, LDC_GROUPS_BIG * 12);
    record_groups(commands);
    bindings.pop_back();
    bindings.push_back({"tiles", tiles_});
    commands.run_indirect(device_.pass("ldc_raster_tiles", {masked}), bindings, p, groups_, LDC_GROUPS_TILES * 12);
}

/// The tables down to the nodes.
void ComputeBuilder::record_nodes(Commands& commands) {
    const LdcParams p = params();
    commands.run_indirect(device_.pass("ldc_top_counts"),
                          {{"node_masks", node_masks_}, {"sums", sums_}, {"counters", counters_}}, p, groups_,
                          LDC_GROUPS_TOPS * 12);
    record_scan(commands, capacity_.tops, offsetof(LdcCounters, tops) / 4);
    commands.run_indirect(device_.pass("ldc_tops"),
                          {{"node_masks", node_masks_},
                           {"sums", sums_},
                           {"top_table", cubes_.top_table},
                           {"top_cells", top_cells_},
                           {"counters", counters_}},
                          p, groups_, LDC_GROUPS_TOPS * 12);
    record_groups(commands);
    commands.run_indirect(device_.pass("ldc_nodes"),
                          {{"counters", counters_},
                           {"node_masks", node_masks_},
                           {"sums", sums_},
                           {"top_cells", top_cells_},
                           {"node_table", cubes_.node_table},
                           {"node_cells", node_cells_},
                           {"bodies", cubes_.body_table}},
                          p, groups_, LDC_GROUPS_OCCUPIED * 12);
}

/// The voxels' lists, sorted.
void ComputeBuilder::record_lists(Commands& commands, const TriangleBuffers& triangles) {
    const LdcParams p = params();
    commands.run_indirect(device_.pass("ldc_count"),
                          {{"counters", counters_},
                           {"top_table", cubes_.top_table},
                           {"node_table", cubes_.node_table},
                           {"fragments", fragments_},
                           {"voxel_counts", voxel_counts_}},
                          p, groups_, LDC_GROUPS_FRAGMENTS * 12);
    commands.run_indirect(device_.pass("ldc_node_sums"),
                          {{"counters", counters_}, {"voxel_counts", voxel_counts_}, {"sums", sums_}}, p, groups_,
                          LDC_GROUPS_NODES * 12);
    record_scan(commands, capacity_.nodes, offsetof(LdcCounters, nodes) / 4);
    commands.run_indirect(device_.pass("ldc_voxels"),
                          {{"counters", counters_},
                           {"voxel_counts", voxel_counts_},
                           {"sums", sums_},
                           {"voxel_table", cubes_.voxel_table},
                           {"long_lists", long_lists_}},
                          p, groups_, LDC_GROUPS_NODES * 12);
    record_groups(commands);
    commands.run_indirect(device_.pass("ldc_scatter"),
                          {{"counters", counters_},
                           {"voxel_table", cubes_.voxel_table},
                           {"fragments", fragments_},
                           {"unsorted_ids", unsorted_ids_}},
                          p, groups_, LDC_GROUPS_FRAGMENTS * 12);
    commands.run_indirect(device_.pass("ldc_sort"),
                          {{"counters", counters_},
                           {"voxel_table", cubes_.voxel_table},
                           {"fragments", fragments_},
                           {"unsorted_ids", unsorted_ids_},
                           {"voxel_counts", voxel_counts_},
                           {"node_cells", node_cells_},
                           {"positions", triangles.positions},
                           {"triangles", triangles.triangles},
                           {"samples", cubes_.samples},
                           {"sample_ids", cubes_.sample_ids},
                           {"bodies", cubes_.body_table}},
                          p, groups_, LDC_GROUPS_FRAGMENTS * 12);
    commands.run_indirect(device_.pass("ldc_sort_long"),
                          {{"counters", counters_},
                           {"voxel_table", cubes_.voxel_table},
                           {"voxel_counts", voxel_counts_},
                           {"long_lists", long_lists_},
                           {"node_cells", node_cells_},
                           {"positions", triangles.positions},
                           {"triangles", triangles.triangles},
                           {"unsorted_ids", unsorted_ids_},
                           {"sample_ids", cubes_.sample_ids},
                           {"samples", cubes_.samples},
                           {"bodies", cubes_.body_table}},
                          p, groups_, LDC_GROUPS_LONG * 12);
}

/// The empty boxes of the 16³ cells.
void ComputeBuilder::record_boxes(Commands& commands) {
    LdcParams p = params();
    for (p.axis = 0; p.axis < 3; p.axis++)
        commands.run_indirect(device_.pass("ldc_sat_scan"),
                              {{"node_masks", node_masks_},
                               {"occupancy_sums", occupancy_sums_},
                               {"bodies", cubes_.body_table},
                               {"counters", counters_}},
                              p, groups_, (LDC_GROUPS_LINES + p.axis) * 12);
    commands.run_indirect(device_.pass("ldc_top_boxes"),
                          {{"node_masks", node_masks_},
                           {"occupancy_sums", occupancy_sums_},
                           {"top_table", cubes_.top_table},
                           {"bodies", cubes_.body_table},
                           {"counters", counters_}},
                          p, groups_, LDC_GROUPS_TOPS_BY_64 * 12);
}

void ComputeBuilder::record(Commands& commands, const TriangleBuffers& triangles) {
    commands.begin_group("build");
    commands.fill(counters_, 0);
    commands.fill(node_masks_, 0, 0, uint64_t(capacity_.tops) * 8);
    commands.fill(voxel_counts_, 0, 0, uint64_t(capacity_.nodes) * 256);
    commands.run(device_.pass("ldc_grids"),
                 {{"body_lower", cubes_.body_lower},
                  {"body_upper", cubes_.body_upper},
                  {"bodies", cubes_.body_table},
                  {"counters", counters_}},
                 params(), {1});
    record_raster(commands, triangles);
    record_nodes(commands);
    record_lists(commands, triangles);
    record_boxes(commands);
    commands.copy(counters_, counters_readback_, sizeof(LdcCounters));
    commands.end_group();
}

bool ComputeBuilder::finish(Commands& commands) {
    std::memcpy(&counts_, counters_readback_.mapped(), sizeof counts_);
    const LdcCounters& counts = counts_;
    if (counts.wrapped) fail("the cube would hold more than 2^32 samples: use a smaller --ldc");
    // A stage that overflowed hides the needs of the later ones, which may ask for yet another turn; there are four
    // stages.
    const uint64_t most = device_.limits().maxStorageBufferRange;
    bool grown = grow_capacity(capacity_.tops, counts.tops, most / 8);
    grown |= grow_capacity(capacity_.big, counts.big, most / 4);
    grown |= grow_capacity(capacity_.tiles, counts.tiles, most / 8);
    // Of these the tables hold those of earlier builds as well.
    grown |= grow_capacity(capacity_.fragments, counts.fragments, most / sizeof(LdcFragment) - before_.samples);
    grown |= grow_capacity(capacity_.occupied, counts.occupied, most / 256 - before_.occupied);
    grown |= grow_capacity(capacity_.nodes, counts.nodes, most / 256 - before_.nodes);
    grown |= grow_capacity(capacity_.long_lists, counts.long_lists, most / 4);
    if (!grown && counts.longest > kLongestListOnCpu && device_.info().kind == "CPU")
        fail(
            "{} triangles crowd into one voxel, more than rays can walk through on the software device '{}' ({}): use "
            "a larger --ldc, "
            "or a GPU",
            counts.longest, device_.info().name, kLongestListOnCpu);
    if (!grown) return true;
    redone_++;
    allocate(commands);
    return false;
}

void ComputeBuilder::build(Commands& commands, const TriangleBuffers& triangles) {
    do {
        record(commands, triangles);
        commands.submit();
    } while (!finish(commands));
}

uint64_t ComputeBuilder::scratch_bytes() const {
    uint64_t bytes = 0;
    for (const Buffer* buffer :
         {&counters_, &groups_, &node_masks_, &fragments_, &big_triangles_, &tiles_, &sums_, &block_sums_, &top_cells_,
          &node_cells_, &voxel_counts_, &long_lists_, &unsorted_ids_, &occupancy_sums_})
        bytes += buffer->bytes();
    return bytes;
}

}  // namespace peelray
