// The box of the middles of all instances' boxes.
#version 460
#include "common/common.glsl"
#include "ldc/tree_params.h"
#include "common/bounds.glsl"
#include "ldc/tree.glsl"
layout(local_size_x = 256) in;
PARAMS(TreeParams)
BUFFER_ALIGNED(readonly, 0, PeelrayBox, unsorted_boxes)
BUFFER(, 1, uvec3, middles)  // lower, upper; as orderedBits

shared uvec3 lowers[256], uppers[256];

void main() {
    const uint lane = gl_LocalInvocationIndex, i = GLOBAL_INDEX;
    uvec3 lower = uvec3(0xffffffffu), upper = uvec3(0u);
    if (i < params.tree.instances && isBox(unsorted_boxes[i])) lower = upper = orderedBits(middleOf(unsorted_boxes[i]));
    lowers[lane] = lower;
    uppers[lane] = upper;
    for (uint step = 128u; step > 0u; step >>= 1u) {
        barrier();
        if (lane < step) {
            lowers[lane] = min(lowers[lane], lowers[lane + step]);
            uppers[lane] = max(uppers[lane], uppers[lane + step]);
        }
    }
    barrier();
    if (lane < 3u) {
        atomicMin(middles[0][lane], lowers[0][lane]);
        atomicMax(middles[1][lane], uppers[0][lane]);
    }
}
