// Puts every fragment's id into its voxel's list, in the order in which the atomics happened to run.
#version 460
#include "ldc_common.glsl"
layout(local_size_x = 128) in;
PARAMS(LdcParams)
BUFFER(readonly, 0, LdcCounters, counters)
BUFFER(readonly, 1, uint, voxel_table)
BUFFER(readonly, 2, LdcFragment, fragments)
BUFFER(writeonly, 3, uint, unsorted_ids)

void main() {
    if (!LDC_FITS(counters[0])) return;
    const uint count = min(counters[0].fragments, params.fragment_capacity);
    const uint i = GLOBAL_INDEX;
    if (i >= count) return;
    unsorted_ids[ldcListStart(voxel_table[params.first_node * 64u + fragments[i].cell]) + fragments[i].local] = fragments[i].id;
}
