// Sorts the long lists by id: one workgroup per list, four rounds of a radix sort; then the samples are written.
#version 460
#include "ldc_common.glsl"
layout(local_size_x = 256) in;
PARAMS(LdcParams)
BUFFER(readonly, 0, LdcCounters, counters)
BUFFER(readonly, 1, uint, voxel_table)
BUFFER(readonly, 2, uint, voxel_counts)
BUFFER(readonly, 3, uint, long_lists)
BUFFER(readonly, 4, uvec2, node_cells)
BUFFER(readonly, 5, vec3, positions)
BUFFER(readonly, 6, uvec3, triangles)
BUFFER(, 7, uint, unsorted_ids)
BUFFER(, 8, uint, sample_ids)
BUFFER(writeonly, 9, uvec2, samples)
BUFFER(readonly, 10, LdcBody, bodies)
#include "ldc_place.glsl"

uint radixDigit(uint id, uint round) { return id >> 8u * round & 255u; }
#include "ldc_radix.glsl"

void main() {
    if (!LDC_FITS(counters[0])) return;
    // Fragments that found no room are missing from the lists: everything is redone.
    if (counters[0].fragments > params.fragment_capacity) return;
    const uint count = min(counters[0].long_lists, params.long_capacity);
    if (GROUP_INDEX >= count) return;
    const uint voxel = long_lists[GROUP_INDEX], length = voxel_counts[voxel];
    const uint start = ldcListStart(voxel_table[params.first_node * 64u + voxel]);
    for (uint digit = 0u; digit < 4u; digit++) radixRound(start, length, digit, (digit & 1u) == 0u);
    for (uint j = gl_LocalInvocationIndex; j < length; j += 256u)
        placeSample(start + j, unsorted_ids[start + j], voxel, j + 1u == length);
}
