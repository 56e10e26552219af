// The 64 node entries of each occupied 16x16x16 cell: an occupied node's number, or an empty node's box.
#version 460
#include "ldc/ldc_common.glsl"
layout(local_size_x = 64) in;
PARAMS(LdcParams)
BUFFER(readonly, 0, LdcCounters, counters)
BUFFER(readonly, 1, uvec2, node_masks)
BUFFER(readonly, 3, uvec2, top_cells)
BUFFER(writeonly, 4, uint, node_table)
BUFFER(writeonly, 5, uvec2, node_cells)
BUFFER(readonly, 6, LdcBody, bodies)
#include "ldc/ldc_bodies.glsl"

void main() {
    const uint lane = gl_LocalInvocationIndex;
    const uint count = min(counters[0].occupied, params.occupied_capacity);
    if (GROUP_INDEX >= count) return;
    const uint top = top_cells[GROUP_INDEX].x;
    const uvec2 mask = node_masks[top];
    uint entry;
    if (ldcMaskBit(mask, lane)) {
        const uint node = top_cells[GROUP_INDEX].y + ldcMaskRank(mask, lane);
        entry = 0x80000000u | (params.first_node + node);
        const uint body = ldcBodyOfCell(params.first_cell + top);
        const uvec3 cell = ldcTopCell(top - ldcFirstCell(body), bodies[body].grid.dims) * 4u + ldcCell64(lane);
        if (node < params.node_capacity) node_cells[node] = uvec2(cell.x | cell.y << 10u | cell.z << 20u, body);
    } else {
        entry = ldcGrowBox(mask, lane);
    }
    node_table[(params.first_occupied + GROUP_INDEX) * 64u + lane] = entry;
}
