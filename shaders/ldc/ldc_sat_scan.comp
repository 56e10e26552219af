// Summed-volume table of the occupied 16x16x16 cells: prefix sums along one axis, one thread per line. The pass of axis 0
// starts from the masks.
#version 460
#include "ldc/ldc_common.glsl"
layout(local_size_x = 64) in;
PARAMS(LdcParams)
BUFFER(readonly, 0, uvec2, node_masks)
BUFFER(, 1, uint, occupancy_sums)
BUFFER(readonly, 2, LdcBody, bodies)
BUFFER(readonly, 3, LdcExtent, extent)
#include "ldc/ldc_bodies.glsl"

void main() {
    const uint axis = params.axis, index = GLOBAL_INDEX;
    if (index >= extent[0].lines[axis] || !LDC_CELLS_FIT(extent[0])) return;
    const uint body = axis == 0u ? ldcBodyOfLineX(index) : (axis == 1u ? ldcBodyOfLineY(index) : ldcBodyOfLineZ(index));
    const uint line = index - bodies[body].first_line[axis];
    const uvec3 tops = bodies[body].grid.dims >> 4u;
    const uvec3 strides = uvec3(1u, tops.x, tops.x * tops.y);
    const uint other1 = (axis + 1u) % 3u, other2 = (axis + 2u) % 3u;
    const uint first = ldcFirstCell(body) + (line % tops[other1]) * strides[other1] + (line / tops[other1]) * strides[other2];
    uint sum = 0u;
    for (uint i = 0u; i < tops[axis]; i++) {
        const uint at = first + i * strides[axis];
        sum += axis == 0u ? (node_masks[at] != uvec2(0) ? 1u : 0u) : occupancy_sums[at];
        occupancy_sums[at] = sum;
    }
}
