// Sorts the instances into buckets along the Morton curve: first, which bucket, and how many are in each.
#version 460
#include "common/common.glsl"
#include "ldc/tree_params.h"
#include "common/bounds.glsl"
#include "ldc/tree.glsl"
layout(local_size_x = 64) in;
PARAMS(TreeParams)
BUFFER_ALIGNED(readonly, 0, PeelrayBox, unsorted_boxes)
BUFFER(readonly, 1, uvec3, middles)
BUFFER(writeonly, 2, TreeKey, tree_keys)
BUFFER(, 3, uvec2, sums)

void main() {
    const uint i = GLOBAL_INDEX;
    if (i >= params.tree.instances) return;
    const PeelrayBox box = unsorted_boxes[i];
    // What has no box comes last.
    uint bucket = (1u << (3u * params.bits)) - 1u;
    if (isBox(box)) bucket = mortonCode(placeIn(middleOf(box), orderedFloats(middles[0]), orderedFloats(middles[1])), params.bits);
    tree_keys[i] = TreeKey(bucket, atomicAdd(sums[bucket].x, 1u));
}
