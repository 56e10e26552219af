// Numbers the occupied 16x16x16 cells and finds the first node of each; the totals go to the counters.
#version 460
#include "ldc_common.glsl"
layout(local_size_x = 256) in;
PARAMS(LdcParams)
BUFFER(readonly, 0, uvec2, node_masks)
BUFFER(readonly, 1, uvec2, sums)
BUFFER(writeonly, 2, uvec2, top_table)
BUFFER(writeonly, 3, uint, top_cells)
BUFFER(, 4, LdcCounters, counters)

void main() {
    const uint i = GLOBAL_INDEX;
    const uint count = counters[0].cells;
    if (i >= count) return;
    const uint nodes = ldcMaskCount(node_masks[i]);
    const uvec2 before = sums[i];
    if (nodes != 0u) {
        top_table[params.first_cell + i] = uvec2(0x80000000u, params.first_occupied + before.x);
        if (before.x < params.occupied_capacity) top_cells[before.x] = i;
    }
    if (i == count - 1u) {
        counters[0].occupied = before.x + (nodes != 0u ? 1u : 0u);
        counters[0].nodes = before.y + nodes;
    }
}
