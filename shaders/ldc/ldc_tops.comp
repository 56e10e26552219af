// Numbers the occupied 16x16x16 cells and their nodes, in the order in which the workgroups happen to run.
#version 460
#include "ldc/ldc_common.glsl"
layout(local_size_x = 256) in;
PARAMS(LdcParams)
BUFFER(readonly, 0, uvec2, node_masks)
BUFFER(writeonly, 1, uvec2, top_table)
BUFFER(writeonly, 2, uvec2, top_cells)
BUFFER(, 3, LdcCounters, counters)

shared uint group_occupied, group_nodes, first_occupied, first_node;

void main() {
    const uint i = GLOBAL_INDEX, lane = gl_LocalInvocationIndex;
    if (lane == 0u) group_occupied = group_nodes = 0u;
    barrier();
    const uint nodes = i < counters[0].cells && LDC_CELLS_FIT(counters[0]) ? ldcMaskCount(node_masks[i]) : 0u;
    uint occupied = 0u, node = 0u;
    if (nodes != 0u) {
        occupied = atomicAdd(group_occupied, 1u);
        node = atomicAdd(group_nodes, nodes);
    }
    barrier();
    if (lane == 0u && group_occupied != 0u) {
        first_occupied = atomicAdd(counters[0].occupied, group_occupied);
        first_node = atomicAdd(counters[0].nodes, group_nodes);
    }
    barrier();
    if (nodes == 0u) return;
    occupied += first_occupied;
    top_table[params.first_cell + i] = uvec2(0x80000000u, params.first_occupied + occupied);
    if (occupied < params.occupied_capacity) top_cells[occupied] = uvec2(i, first_node + node);
}
