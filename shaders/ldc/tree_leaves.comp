// The lowest level of the hierarchy: the instances' boxes along the Morton curve, those of a bucket by their number.
#version 460
#include "common/common.glsl"
#include "ldc/tree_params.h"
#include "ldc/tree.glsl"
layout(local_size_x = 64) in;
PARAMS(TreeParams)
BUFFER_ALIGNED(readonly, 0, PeelrayBox, unsorted_boxes)
BUFFER(readonly, 1, TreeKey, tree_keys)
BUFFER(readonly, 2, uvec2, sums)
BUFFER(readonly, 3, uint, unsorted_instances)
BUFFER_ALIGNED(writeonly, 4, PeelrayBox, instance_boxes)

/// A bucket that holds more is left in the order in which the atomics ran: counting would take too long, and the order
/// only decides which of two coincident surfaces of two instances is seen.
const uint LONGEST_BUCKET = 8192u;

void main() {
    const uint i = GLOBAL_INDEX, count = params.tree.instances;
    if (i >= ((count + 7u) & ~7u)) return;
    if (i >= count) {
        instance_boxes[i] = NO_BOX;
        return;
    }
    const TreeKey key = tree_keys[i];
    const uint first = sums[key.bucket].x, last = key.bucket + 1u < 1u << (3u * params.bits) ? sums[key.bucket + 1u].x : count;
    uint rank = key.slot;
    if (last - first <= LONGEST_BUCKET) {
        rank = 0u;
        for (uint j = first; j < last; j++) rank += unsorted_instances[j] < i ? 1u : 0u;
    }
    instance_boxes[first + rank] = unsorted_boxes[i];
}
