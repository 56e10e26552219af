// A higher level of the hierarchy: the boxes of eight boxes each.
#version 460
#include "common/common.glsl"
#include "ldc/tree_params.h"
#include "ldc/tree.glsl"
layout(local_size_x = 64) in;
PARAMS(TreeParams)
BUFFER_ALIGNED(, 0, PeelrayBox, instance_boxes)

void main() {
    const uint i = GLOBAL_INDEX;
    if (i >= params.filled) return;
    PeelrayBox box = NO_BOX;
    if (i < params.boxes)
        for (uint k = 0u; k < 8u; k++) box = unionOf(box, instance_boxes[params.tree.first[params.level - 1u] + 8u * i + k]);
    instance_boxes[params.tree.first[params.level] + i] = box;
}
