// The empty box around each empty 16x16x16 cell: grown greedily, face by face in doubling steps, on the summed-volume table.
#version 460
#include "ldc/ldc_common.glsl"
layout(local_size_x = 64) in;
PARAMS(LdcParams)
BUFFER(readonly, 0, uvec2, node_masks)
BUFFER(readonly, 1, uint, occupancy_sums)
BUFFER(writeonly, 2, uvec2, top_table)
BUFFER(readonly, 3, LdcBody, bodies)
BUFFER(readonly, 4, LdcExtent, extent)
#include "ldc/ldc_bodies.glsl"

uint first_top;  // of the body, in the build's tables

uint sumBelow(ivec3 p, ivec3 tops) {
    if (p.x < 0 || p.y < 0 || p.z < 0) return 0u;
    return occupancy_sums[first_top + uint((p.z * tops.y + p.y) * tops.x + p.x)];
}

bool boxEmpty(ivec3 lo, ivec3 hi, ivec3 tops) {
    lo -= 1;
    return sumBelow(hi, tops) + sumBelow(ivec3(lo.xy, hi.z), tops) + sumBelow(ivec3(lo.x, hi.y, lo.z), tops) +
               sumBelow(ivec3(hi.x, lo.yz), tops) ==
           sumBelow(ivec3(lo.x, hi.yz), tops) + sumBelow(ivec3(hi.x, lo.y, hi.z), tops) + sumBelow(ivec3(hi.xy, lo.z), tops) +
               sumBelow(lo, tops);
}

void main() {
    const uint i = GLOBAL_INDEX;
    if (i >= extent[0].cells || !LDC_CELLS_FIT(extent[0]) || node_masks[i] != uvec2(0)) return;
    const uint body = ldcBodyOfCell(params.first_cell + i);
    first_top = ldcFirstCell(body);
    const ivec3 tops = ivec3(bodies[body].grid.dims >> 4u);
    ivec3 lo = ivec3(ldcTopCell(i - first_top, bodies[body].grid.dims)), hi = lo;
    int steps[6] = int[](1, 1, 1, 1, 1, 1);
    for (int round = 0; round < 12; round++) {
        bool grown = false;
        for (int face = 0; face < 6; face++) {
            const int axis = face >> 1;
            for (int step = steps[face]; step > 0; step >>= 1) {
                ivec3 slab_lo = lo, slab_hi = hi;
                if ((face & 1) != 0) {
                    slab_lo[axis] = hi[axis] + 1;
                    slab_hi[axis] = min(tops[axis] - 1, hi[axis] + step);
                } else {
                    slab_hi[axis] = lo[axis] - 1;
                    slab_lo[axis] = max(0, lo[axis] - step);
                }
                steps[face] = 0;
                if (slab_lo[axis] > slab_hi[axis]) break;
                if (boxEmpty(slab_lo, slab_hi, tops)) {
                    lo = min(lo, slab_lo);
                    hi = max(hi, slab_hi);
                    steps[face] = min(32, step * 2);
                    grown = true;
                    break;
                }
            }
        }
        if (!grown) break;
    }
    const uvec3 l = uvec3(lo), h = uvec3(hi);
    top_table[params.first_cell + i] = uvec2(l.x | l.y << 10u | l.z << 20u, h.x | h.y << 10u | h.z << 20u);
}
