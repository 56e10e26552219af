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

uint32_t top_count(const CubeGrid& grid) {
    return (grid.dims.x / 16) * (grid.dims.y / 16) * (grid.dims.z / 16);
}

uint32_t with_reserve(uint32_t needed) {
    return uint32_t(std::min<uint64_t>(uint64_t(needed) * 3 / 2 + 64, 0x7fffffffu));
}

/// Grows `capacity` if `needed` exceeds it; tells whether it did.
bool grow(uint32_t& capacity, uint32_t needed) {
    if (needed <= capacity) return false;
    capacity = with_reserve(needed);
    return true;
}

}  // namespace

ComputeBuilder::ComputeBuilder(Device& device) : device_(device) {
    counters_ = Buffer(device, "build counters", sizeof(LdcCounters));
    groups_ = Buffer(device, "build workgroups", LDC_GROUPS * 12);
    counters_readback_ = Buffer(device, "build counters readback", sizeof(LdcCounters), Buffer::Where::readback);
}

void ComputeBuilder::prepare(Cube& cube, const TriangleBuffers& triangles, uint32_t resolution, Sampling sampling) {
    cube.grid = make_grid(triangles.lower, triangles.upper, resolution);
    cube.sampling = sampling;
    triangles_ = triangles.count;
    // Guesses: a surface fills about two samples per pixel and LDI; what is too little is counted, grown and redone.
    const glm::uvec3& d = cube.grid.dims;
    const uint64_t pixels = uint64_t(d.x) * d.y + uint64_t(d.y) * d.z + uint64_t(d.z) * d.x;
    const uint64_t most = device_.limits().maxStorageBufferRange;
    const auto guess = [&](uint32_t& capacity, uint64_t count, uint64_t bytes_each) {
        capacity = std::max(capacity, uint32_t(std::min(count, most / bytes_each)));
    };
    guess(capacity_.fragments, 2 * pixels + 4ull * triangles.count, sizeof(LdcFragment));
    guess(capacity_.nodes, pixels / 8 + 256, 256);
    guess(capacity_.tops, std::min<uint64_t>(top_count(cube.grid), pixels / 64 + 64), 256);
    guess(capacity_.big, 4096, 4);
    guess(capacity_.tiles, pixels / 64 + 4096, 8);
    guess(capacity_.long_lists, 1024, 4);
    allocate(cube);
}

void ComputeBuilder::allocate(Cube& cube) {
    const uint64_t tops = top_count(cube.grid);
    const uint64_t sums = std::max<uint64_t>(tops, capacity_.nodes);
    ensure_size(device_, node_masks_, "node masks", tops * 8);
    ensure_size(device_, occupancy_sums_, "occupancy sums", tops * 4);
    ensure_size(device_, cube.top_table, "the cube's top table", tops * 8);
    ensure_size(device_, sums_, "prefix sums", sums * 8);
    ensure_size(device_, block_sums_, "prefix sums of blocks", (sums / SCAN_BLOCK + 2) * 8);
    ensure_size(device_, top_cells_, "occupied cells", uint64_t(capacity_.tops) * 4);
    ensure_size(device_, cube.node_table, "the cube's nodes", uint64_t(capacity_.tops) * 256);
    ensure_size(device_, node_cells_, "occupied nodes", uint64_t(capacity_.nodes) * 4);
    ensure_size(device_, voxel_counts_, "voxel counts", uint64_t(capacity_.nodes) * 256);
    ensure_size(device_, cube.voxel_table, "the cube's voxels", uint64_t(capacity_.nodes) * 256);
    ensure_size(device_, fragments_, "fragments", uint64_t(capacity_.fragments) * sizeof(LdcFragment));
    ensure_size(device_, unsorted_ids_, "unsorted samples", uint64_t(capacity_.fragments) * 4);
    ensure_size(device_, cube.samples, "the cube's samples", uint64_t(capacity_.fragments) * 8);
    ensure_size(device_, cube.sample_ids, "the cube's sample ids", uint64_t(capacity_.fragments) * 4);
    ensure_size(device_, big_triangles_, "queue of large triangles", uint64_t(capacity_.big) * 4);
    ensure_size(device_, tiles_, "queue of tiles", uint64_t(capacity_.tiles) * 8);
    ensure_size(device_, long_lists_, "queue of long lists", uint64_t(capacity_.long_lists) * 4);
}

LdcParams ComputeBuilder::params(const Cube& cube) const {
    LdcParams p{};
    p.grid = cube.grid;
    p.triangles = triangles_;
    p.planar = cube.sampling == Sampling::centre;
    p.fragment_capacity = capacity_.fragments;
    p.big_capacity = capacity_.big;
    p.tile_capacity = capacity_.tiles;
    p.top_capacity = capacity_.tops;
    p.node_capacity = capacity_.nodes;
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

void ComputeBuilder::record(Commands& commands, const TriangleBuffers& triangles, Cube& cube) {
    LdcParams p = params(cube);
    const uint32_t tops = top_count(cube.grid);
    const Groups top_groups = groups_for(tops, 256);
    commands.begin_group("build");
    commands.fill(counters_, 0);
    commands.fill(node_masks_, 0, 0, uint64_t(tops) * 8);
    commands.fill(voxel_counts_, 0, 0, uint64_t(capacity_.nodes) * 256);

    commands.run(device_.pass("ldc_raster"),
                 {{"positions", triangles.positions},
                  {"triangles", triangles.triangles},
                  {"counters", counters_},
                  {"node_masks", node_masks_},
                  {"fragments", fragments_},
                  {"big_triangles", big_triangles_}},
                 p, groups_for(triangles.count, 64));
    commands.run(device_.pass("ldc_groups"), {{"counters", counters_}, {"groups", groups_}}, p, {1});
    commands.run_indirect(device_.pass("ldc_tiles"),
                          {{"positions", triangles.positions},
                           {"triangles", triangles.triangles},
                           {"counters", counters_},
                           {"big_triangles", big_triangles_},
                           {"tiles", tiles_}},
                          p, groups_, LDC_GROUPS_BIG * 12);
    commands.run(device_.pass("ldc_groups"), {{"counters", counters_}, {"groups", groups_}}, p, {1});
    commands.run_indirect(device_.pass("ldc_raster_tiles"),
                          {{"positions", triangles.positions},
                           {"triangles", triangles.triangles},
                           {"counters", counters_},
                           {"node_masks", node_masks_},
                           {"fragments", fragments_},
                           {"tiles", tiles_}},
                          p, groups_, LDC_GROUPS_TILES * 12);

    commands.run(device_.pass("ldc_top_counts"), {{"node_masks", node_masks_}, {"sums", sums_}}, p, top_groups);
    record_scan(commands, tops, SCAN_NO_COUNTER);
    commands.run(device_.pass("ldc_tops"),
                 {{"node_masks", node_masks_},
                  {"sums", sums_},
                  {"top_table", cube.top_table},
                  {"top_cells", top_cells_},
                  {"counters", counters_}},
                 p, top_groups);
    commands.run(device_.pass("ldc_groups"), {{"counters", counters_}, {"groups", groups_}}, p, {1});
    commands.run_indirect(device_.pass("ldc_nodes"),
                          {{"counters", counters_},
                           {"node_masks", node_masks_},
                           {"sums", sums_},
                           {"top_cells", top_cells_},
                           {"node_table", cube.node_table},
                           {"node_cells", node_cells_}},
                          p, groups_, LDC_GROUPS_TOPS * 12);
    commands.run_indirect(device_.pass("ldc_count"),
                          {{"counters", counters_},
                           {"top_table", cube.top_table},
                           {"node_table", cube.node_table},
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
                           {"voxel_table", cube.voxel_table},
                           {"long_lists", long_lists_}},
                          p, groups_, LDC_GROUPS_NODES * 12);
    commands.run(device_.pass("ldc_groups"), {{"counters", counters_}, {"groups", groups_}}, p, {1});
    commands.run_indirect(device_.pass("ldc_scatter"),
                          {{"counters", counters_},
                           {"voxel_table", cube.voxel_table},
                           {"fragments", fragments_},
                           {"unsorted_ids", unsorted_ids_}},
                          p, groups_, LDC_GROUPS_FRAGMENTS * 12);
    commands.run_indirect(device_.pass("ldc_sort"),
                          {{"counters", counters_},
                           {"voxel_table", cube.voxel_table},
                           {"fragments", fragments_},
                           {"unsorted_ids", unsorted_ids_},
                           {"voxel_counts", voxel_counts_},
                           {"node_cells", node_cells_},
                           {"positions", triangles.positions},
                           {"triangles", triangles.triangles},
                           {"samples", cube.samples},
                           {"sample_ids", cube.sample_ids}},
                          p, groups_, LDC_GROUPS_FRAGMENTS * 12);
    commands.run_indirect(device_.pass("ldc_sort_long"),
                          {{"counters", counters_},
                           {"voxel_table", cube.voxel_table},
                           {"voxel_counts", voxel_counts_},
                           {"long_lists", long_lists_},
                           {"node_cells", node_cells_},
                           {"positions", triangles.positions},
                           {"triangles", triangles.triangles},
                           {"unsorted_ids", unsorted_ids_},
                           {"sample_ids", cube.sample_ids},
                           {"samples", cube.samples}},
                          p, groups_, LDC_GROUPS_LONG * 12);

    const glm::uvec3 t = cube.grid.dims / 16u;
    for (p.axis = 0; p.axis < 3; p.axis++)
        commands.run(device_.pass("ldc_sat_scan"), {{"node_masks", node_masks_}, {"occupancy_sums", occupancy_sums_}},
                     p, groups_for(uint64_t(t[(p.axis + 1) % 3]) * t[(p.axis + 2) % 3], 64));
    commands.run(device_.pass("ldc_top_boxes"),
                 {{"node_masks", node_masks_}, {"occupancy_sums", occupancy_sums_}, {"top_table", cube.top_table}}, p,
                 groups_for(tops, 64));
    commands.copy(counters_, counters_readback_, sizeof(LdcCounters));
    commands.end_group();
}

bool ComputeBuilder::finish(Cube& cube) {
    std::memcpy(&cube.counts, counters_readback_.mapped(), sizeof cube.counts);
    const LdcCounters& counts = cube.counts;
    if (counts.wrapped) fail("the cube would hold more than 2^32 samples: use a smaller --ldc");
    // A stage that overflowed hides the needs of the later ones, which may ask for yet another turn; there are three
    // stages.
    bool grown = grow(capacity_.big, counts.big);
    grown |= grow(capacity_.tiles, counts.tiles);
    grown |= grow(capacity_.fragments, counts.fragments);
    grown |= grow(capacity_.tops, counts.tops);
    grown |= grow(capacity_.nodes, counts.nodes);
    grown |= grow(capacity_.long_lists, counts.long_lists);
    if (!grown && counts.longest > kLongestListOnCpu && device_.info().kind == "CPU")
        fail(
            "{} triangles crowd into one voxel, more than rays can walk through on the software device '{}' ({}): use "
            "a larger --ldc, "
            "or a GPU",
            counts.longest, device_.info().name, kLongestListOnCpu);
    if (!grown) return true;
    redone_++;
    allocate(cube);
    return false;
}

void ComputeBuilder::build(Commands& commands, const TriangleBuffers& triangles, Cube& cube, uint32_t resolution,
                           Sampling sampling) {
    prepare(cube, triangles, resolution, sampling);
    do {
        record(commands, triangles, cube);
        commands.submit();
    } while (!finish(cube));
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
