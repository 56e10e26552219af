// Workgroups of the passes whose work is counted on the GPU.
#version 460
#include "common.glsl"
#include "params.h"
layout(local_size_x = 1) in;
PARAMS(LdcParams)
BUFFER(readonly, 0, LdcCounters, counters)
BUFFER(writeonly, 1, uvec3, groups)

uvec3 rows(uint count) { return uvec3(min(count, DISPATCH_ROW), (count + DISPATCH_ROW - 1u) / DISPATCH_ROW, 1u); }

void main() {
    const bool fits = counters[0].cells <= params.cell_capacity;
    const uint cells = fits ? counters[0].cells : 0u;
    groups[LDC_GROUPS_BLOCKS] = rows(min(counters[0].blocks, params.block_capacity));
    groups[LDC_GROUPS_OCCUPIED] = rows(min(counters[0].occupied, params.occupied_capacity));
    groups[LDC_GROUPS_NODES] = rows((min(counters[0].nodes, params.node_capacity) + 3u) / 4u);
    groups[LDC_GROUPS_FRAGMENTS] = rows((min(counters[0].fragments, params.fragment_capacity) + 127u) / 128u);
    groups[LDC_GROUPS_LONG] = rows(min(counters[0].long_lists, params.long_capacity));
    groups[LDC_GROUPS_CELLS] = rows((cells + 255u) / 256u);
    groups[LDC_GROUPS_CELLS_BY_64] = rows((cells + 63u) / 64u);
    for (uint axis = 0u; axis < 3u; axis++) groups[LDC_GROUPS_LINES + axis] = rows(fits ? (counters[0].lines[axis] + 63u) / 64u : 0u);
}
