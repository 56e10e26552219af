#include "ldc/pixel_order.h"
#include "common/scan_params.h"

#include <algorithm>
#include <cstddef>

namespace peelray {

/// A surface fills about one sample per pixel and LDI; what is too little is counted, grown and redone.
void PixelOrder::guess(BuildState& state, const BuildSize& size) {
    LdcParams& p = state.params;
    const uint64_t pixels = size.pixels + size.pixels / 8 + 512;
    p.cell_capacity = bounded(state, pixels, 8);
    p.fragment_capacity = bounded(state, size.pixels + 4 * size.triangles, sizeof(LdcFragment));
    p.long_capacity = bounded(state, 1024, 4);
}

void PixelOrder::allocate(Commands& commands, BuildState& state) {
    const LdcParams& p = state.params;
    const uint64_t cells = p.cell_capacity;
    state.cubes.reserve(commands, state.before + TableSize{cells, 0, 0, p.fragment_capacity}, state.before);
    Device& device = state.device;
    ensure_size(device, state.node_masks, "node masks", 8);
    ensure_size(device, state.captured, "captured attributes", 16);
    ensure_size(device, pixel_counts_, "samples of pixels", cells * 4);
    ensure_size(device, sums_, "prefix sums", cells * 8);
    ensure_size(device, block_sums_, "prefix sums of blocks", (cells / SCAN_BLOCK + 2) * 8);
    ensure_size(device, slots_, "slots of fragments", uint64_t(p.fragment_capacity) * 4);
    ensure_size(device, unsorted_ids_, "unsorted samples", uint64_t(p.fragment_capacity) * 4);
    ensure_size(device, long_lists_, "queue of long lists", uint64_t(p.long_capacity) * 4);
}

void PixelOrder::clear(Commands& commands, const BuildState& state) {
    commands.fill(pixel_counts_, 0, 0, uint64_t(state.params.cell_capacity) * 4);
}

void PixelOrder::record(Commands& commands, const BuildState& state, const TriangleBuffers& triangles) {
    record_lists(commands, state, triangles);
    record_ranges(commands, state);
    commands.copy(state.counters, state.readback, sizeof(LdcCounters));
}

void PixelOrder::record_lists(Commands& commands, const BuildState& state, const TriangleBuffers& triangles) {
    Device& device = state.device;
    const uint32_t streams = state.cubes.layout().streams;
    const LdcParams& p = state.params;
    state.record_groups(commands);
    commands.run_indirect(device.pass("ldc_pixel_count"),
                          {{"counters", state.counters},
                           {"fragments", state.fragments},
                           {"pixel_counts", pixel_counts_},
                           {"slots", slots_}},
                          p, state.groups, LDC_GROUPS_FRAGMENTS * 12);
    commands.run_indirect(
        device.pass("ldc_pixel_sums"),
        {{"counters", state.counters}, {"pixel_counts", pixel_counts_}, {"sums", sums_}, {"long_lists", long_lists_}},
        p, state.groups, LDC_GROUPS_CELLS * 12);
    record_scan(commands, state, p.cell_capacity, offsetof(LdcCounters, cells) / 4, sums_, block_sums_);
    commands.run_indirect(device.pass("ldc_pixel_offsets"),
                          {{"counters", state.counters}, {"sums", sums_}, {"pixel_offsets", state.cubes.pixel_offsets}},
                          p, state.groups, LDC_GROUPS_CELLS * 12);
    state.record_groups(commands);
    commands.run_indirect(device.pass("ldc_pixel_scatter"),
                          {{"counters", state.counters},
                           {"fragments", state.fragments},
                           {"slots", slots_},
                           {"sums", sums_},
                           {"unsorted_ids", unsorted_ids_}},
                          p, state.groups, LDC_GROUPS_FRAGMENTS * 12);
    commands.run_indirect(device.pass("ldc_pixel_sort", {{"streams", streams}}),
                          {{"counters", state.counters},
                           {"fragments", state.fragments},
                           {"pixel_counts", pixel_counts_},
                           {"sums", sums_},
                           {"unsorted_ids", unsorted_ids_},
                           {"positions", triangles.positions},
                           {"triangles", triangles.triangles},
                           {"bodies", state.cubes.table.entries},
                           {"samples", state.cubes.samples},
                           {"sample_ids", state.cubes.sample_ids},
                           {"captured", state.captured},
                           {"sample_attributes", state.cubes.sample_attributes}},
                          p, state.groups, LDC_GROUPS_FRAGMENTS * 12);
    commands.run_indirect(device.pass("ldc_pixel_sort_long", {{"streams", streams}}),
                          {{"counters", state.counters},
                           {"fragments", state.fragments},
                           {"pixel_counts", pixel_counts_},
                           {"sums", sums_},
                           {"long_lists", long_lists_},
                           {"positions", triangles.positions},
                           {"triangles", triangles.triangles},
                           {"bodies", state.cubes.table.entries},
                           {"samples", state.cubes.samples},
                           {"sample_ids", state.cubes.sample_ids},
                           {"unsorted_ids", unsorted_ids_},
                           {"captured", state.captured},
                           {"sample_attributes", state.cubes.sample_attributes}},
                          p, state.groups, LDC_GROUPS_LONG * 12);
}

void PixelOrder::record_ranges(Commands& commands, const BuildState& state) {
    const CubeLayout& layout = state.cubes.layout();
    LdcParams p = state.params;
    const bool pyramid = layout.traversal == Traversal::mipmap;
    const glm::uvec2 block = pyramid ? glm::uvec2(2) : layout.block;
    p.block = block.x | block.y << 16;
    commands.run(state.device.pass("ldc_ranges"),
                 {{"counters", state.counters},
                  {"bodies", state.cubes.table.entries},
                  {"pixel_offsets", state.cubes.pixel_offsets},
                  {"samples", state.cubes.samples},
                  {"pixel_ranges", state.cubes.pixel_ranges}},
                 p, groups_for(p.cell_capacity / 4, 64));
    if (!pyramid) return;
    for (p.level = 2; p.level <= state.cubes.pyramid_levels(); p.level++)
        commands.run(state.device.pass("ldc_ranges_up"),
                     {{"counters", state.counters},
                      {"bodies", state.cubes.table.entries},
                      {"pixel_ranges", state.cubes.pixel_ranges}},
                     p, groups_for(p.cell_capacity >> std::min(2 * p.level, 8u), 64));
}

bool PixelOrder::grow(BuildState& state, const BuildCounts& counts) {
    LdcParams& p = state.params;
    bool grown = grow_capacity(p.cell_capacity, counts.cells,
                               std::min(state.most() / 8, left_of(state.most() / 4, state.before.cells)));
    grown |= grow_capacity(p.fragment_capacity, counts.fragments,
                           left_of(state.most() / sizeof(LdcFragment), state.before.samples));
    grown |= grow_capacity(p.long_capacity, counts.long_lists, state.most() / 4);
    return grown;
}

uint64_t PixelOrder::bytes() const {
    uint64_t bytes = 0;
    for (const Buffer* buffer : {&pixel_counts_, &slots_, &sums_, &block_sums_, &unsorted_ids_, &long_lists_})
        bytes += buffer->bytes();
    return bytes;
}

}  // namespace peelray
