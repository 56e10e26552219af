// Adds what the rays of a level's children cost to that of its own: from the deepest level back to the camera.
#version 460
#include "common.glsl"
#include "params.h"
layout(local_size_x = 64) in;
PARAMS(LevelParams)
BUFFER(, 0, PeelrayCounts, costs)
BUFFER(readonly, 1, PeelrayCounts, next_costs)
BUFFER(readonly, 2, PathNode, nodes)
BUFFER(readonly, 3, uint, queue)
#include "cost_sums.glsl"

void main() {
    const uint i = GLOBAL_INDEX;
    if (i >= min(params.capacity, queue[params.level])) return;
    const PathNode node = nodes[i];
    PeelrayCounts sum = costs[i];
    if (node.child0 < params.next_capacity) sum = costSum(sum, next_costs[node.child0]);
    if (node.child1 < params.next_capacity) sum = costSum(sum, next_costs[node.child1]);
    costs[i] = sum;
}
