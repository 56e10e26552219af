// Per 16x16x16 cell: is it occupied, and how many nodes has it? Input of the first prefix sum.
#version 460
#include "ldc_common.glsl"
layout(local_size_x = 256) in;
PARAMS(LdcParams)
BUFFER(readonly, 0, uvec2, node_masks)
BUFFER(writeonly, 1, uvec2, sums)

void main() {
    const uint i = GLOBAL_INDEX;
    const uvec3 tops = params.grid.dims >> 4u;
    if (i >= tops.x * tops.y * tops.z) return;
    const uint nodes = ldcMaskCount(node_masks[i]);
    sums[i] = uvec2(nodes != 0u ? 1u : 0u, nodes);
}
