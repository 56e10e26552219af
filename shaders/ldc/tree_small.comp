// The hierarchy over up to TREE_SMALL instances, in one workgroup.
#version 460
#include "common/common.glsl"
#include "ldc/tree_params.h"
#include "ldc/tree.glsl"
layout(local_size_x = 256) in;
PARAMS(TreeParams)
BUFFER_ALIGNED(readonly, 0, PeelrayBox, unsorted_boxes)
BUFFER_ALIGNED(coherent, 1, PeelrayBox, instance_boxes)

shared vec3 lowers[256], uppers[256];
shared uint keys[TREE_SMALL];

/// The box of the middles of all boxes, in lowers[0] and uppers[0].
void findMiddles() {
    const uint lane = gl_LocalInvocationIndex;
    vec3 lower = vec3(1e30), upper = vec3(-1e30);
    for (uint i = lane; i < params.tree.instances; i += 256u) {
        const PeelrayBox box = unsorted_boxes[i];
        if (!isBox(box)) continue;
        lower = min(lower, middleOf(box));
        upper = max(upper, middleOf(box));
    }
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
}

void main() {
    const uint lane = gl_LocalInvocationIndex, count = params.tree.instances, padded = (count + 7u) & ~7u;
    findMiddles();
    for (uint i = lane; i < count; i += 256u) {
        const PeelrayBox box = unsorted_boxes[i];
        keys[i] = isBox(box) ? mortonCode(placeIn(middleOf(box), lowers[0], uppers[0]), 7u) : 0xffffffffu;
    }
    barrier();
    // Each counts those before it: few enough that nothing else is faster. Equal keys keep their order.
    for (uint i = lane; i < padded; i += 256u) {
        uint rank = i;
        if (i < count) {
            rank = 0u;
            for (uint j = 0u; j < count; j++) rank += keys[j] < keys[i] || (keys[j] == keys[i] && j < i) ? 1u : 0u;
        }
        PeelrayBox box = NO_BOX;
        if (i < count) box = unsorted_boxes[i];
        instance_boxes[rank] = box;
    }
    uint below = padded;
    for (uint level = 1u; level < params.tree.levels; level++) {
        memoryBarrierBuffer();
        barrier();
        const uint boxes = below / 8u, filled = (boxes + 7u) & ~7u;
        for (uint i = lane; i < filled; i += 256u) {
            PeelrayBox box = NO_BOX;
            if (i < boxes)
                for (uint k = 0u; k < 8u; k++) box = unionOf(box, instance_boxes[params.tree.first[level - 1u] + 8u * i + k]);
            instance_boxes[params.tree.first[level] + i] = box;
        }
        below = filled;
    }
}
