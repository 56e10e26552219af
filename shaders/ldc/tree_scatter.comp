// Puts every instance into its bucket, in the order in which the atomics happened to run.
#version 460
#include "common/common.glsl"
#include "ldc/tree_params.h"
layout(local_size_x = 64) in;
PARAMS(TreeParams)
BUFFER(readonly, 0, TreeKey, tree_keys)
BUFFER(readonly, 1, uvec2, sums)
BUFFER(writeonly, 2, uint, unsorted_instances)

void main() {
    const uint i = GLOBAL_INDEX;
    if (i >= params.tree.instances) return;
    unsorted_instances[sums[tree_keys[i].bucket].x + tree_keys[i].slot] = i;
}
