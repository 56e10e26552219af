// Finds each fragment's voxel entry and counts it there.
#version 460
#include "ldc/ldc_common.glsl"
layout(local_size_x = 128) in;
PARAMS(LdcParams)
BUFFER(readonly, 0, LdcCounters, counters)
BUFFER(readonly, 1, uvec2, top_table)
BUFFER(readonly, 2, uint, node_table)
BUFFER(, 3, LdcFragment, fragments)
BUFFER(, 4, uint, voxel_counts)

void main() {
    // Everything is redone when it did not fit: then nothing here may be trusted.
    if (!LDC_FITS(counters[0])) return;
    const uint count = min(counters[0].fragments, params.fragment_capacity);
    const uint i = GLOBAL_INDEX;
    if (i >= count) return;
    const LdcFragment f = fragments[i];
    const uint node = node_table[top_table[params.first_cell + f.cell].y * 64u + (f.local >> 6u)] & 0x7fffffffu;
    const uint voxel = (node - params.first_node) * 64u + (f.local & 63u);
    fragments[i].cell = voxel;
    fragments[i].local = atomicAdd(voxel_counts[voxel], 1u);
}
