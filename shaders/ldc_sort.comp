// Sorts the short lists by id, so that the same input always gives the same order: each fragment counts those before it.
// Writes the samples.
#version 460
#include "ldc_common.glsl"
layout(local_size_x = 128) in;
PARAMS(LdcParams)
BUFFER(readonly, 0, LdcCounters, counters)
BUFFER(readonly, 1, uint, voxel_table)
BUFFER(readonly, 2, LdcFragment, fragments)
BUFFER(readonly, 3, uint, unsorted_ids)
BUFFER(readonly, 4, uint, voxel_counts)
BUFFER(readonly, 5, uvec2, node_cells)
BUFFER(readonly, 6, vec3, positions)
BUFFER(readonly, 7, uvec3, triangles)
BUFFER(writeonly, 8, uvec2, samples)
BUFFER(writeonly, 9, uint, sample_ids)
BUFFER(readonly, 10, LdcBody, bodies)
#include "ldc_place.glsl"

void main() {
    if (!LDC_FITS(counters[0])) return;
    const uint count = min(counters[0].fragments, params.fragment_capacity);
    const uint i = GLOBAL_INDEX;
    if (i >= count) return;
    const uint voxel = fragments[i].cell, id = fragments[i].id;
    const uint length = voxel_counts[voxel];
    if (length > LDC_LONG_LIST) return;
    const uint start = ldcListStart(voxel_table[params.first_node * 64u + voxel]);
    uint rank = 0u;
    for (uint j = start; j < start + length; j++) rank += unsorted_ids[j] < id ? 1u : 0u;
    placeSample(start + rank, id, voxel, rank + 1u == length);
}
