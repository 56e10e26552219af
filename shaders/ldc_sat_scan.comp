// Summed-volume table of the occupied 16x16x16 cells: prefix sums along one axis, one thread per line. The pass of axis 0
// starts from the masks.
#version 460
#include "ldc_common.glsl"
layout(local_size_x = 64) in;
PARAMS(LdcParams)
BUFFER(readonly, 0, uvec2, node_masks)
BUFFER(, 1, uint, occupancy_sums)

void main() {
    const uvec3 tops = params.grid.dims >> 4u;
    const uvec3 strides = uvec3(1u, tops.x, tops.x * tops.y);
    const uint axis = params.axis, other1 = (axis + 1u) % 3u, other2 = (axis + 2u) % 3u;
    const uint line = GLOBAL_INDEX;
    if (line >= tops[other1] * tops[other2]) return;
    const uint first = (line % tops[other1]) * strides[other1] + (line / tops[other1]) * strides[other2];
    uint sum = 0u;
    for (uint i = 0u; i < tops[axis]; i++) {
        const uint at = first + i * strides[axis];
        sum += axis == 0u ? (node_masks[at] != uvec2(0) ? 1u : 0u) : occupancy_sums[at];
        occupancy_sums[at] = sum;
    }
}
