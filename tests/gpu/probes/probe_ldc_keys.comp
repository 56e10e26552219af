// Permutations, keys and masks.
#version 460
#include "ldc/ldc_common.glsl"
#include "probe.glsl"
struct Input { uvec3 voxel, dims; uint axis; uvec2 mask; uint bit; };
struct Output { uvec3 to, back; uint top, node, inner; uvec3 top_cell, node_cell, inner_cell; uint set, count, rank, box; };
PROBE(Input, Output)

Output probe(Input x) {
    Output o;
    o.to = uvec3(peelrayToLdi(vec3(x.voxel), x.axis));
    o.back = ldcFromLdi(o.to, x.axis);
    o.top = ldcTopIndex(x.voxel, x.dims);
    o.node = ldcNodeInTop(x.voxel);
    o.inner = ldcVoxelInNode(x.voxel);
    o.top_cell = ldcTopCell(o.top, x.dims);
    o.node_cell = ldcCell64(o.node);
    o.inner_cell = ldcCell64(o.inner);
    o.set = ldcMaskBit(x.mask, x.bit) ? 1u : 0u;
    o.count = ldcMaskCount(x.mask);
    o.rank = ldcMaskRank(x.mask, x.bit);
    o.box = o.set != 0u ? 0xffffffffu : ldcGrowBox(x.mask, x.bit);
    return o;
}
