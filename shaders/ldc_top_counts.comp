// Per 16x16x16 cell: is it occupied, and how many nodes has it? Input of the first prefix sum.
#version 460
#include "ldc_common.glsl"
layout(local_size_x = 256) in;
PARAMS(LdcParams)
BUFFER(readonly, 0, uvec2, node_masks)
BUFFER(writeonly, 1, uvec2, sums)
BUFFER(readonly, 2, LdcCounters, counters)

void main() {
    const uint i = GLOBAL_INDEX;
    if (i >= min(counters[0].cells, params.cell_capacity)) return;
    const uint nodes = ldcMaskCount(node_masks[i]);
    sums[i] = uvec2(nodes != 0u ? 1u : 0u, nodes);
}
