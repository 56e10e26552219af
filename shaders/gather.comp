// Adds the light of a level's children to its nodes: from the deepest level back to the camera.
#version 460
#include "common.glsl"
#include "params.h"
layout(local_size_x = 64) in;
PARAMS(LevelParams)
BUFFER(, 0, PathNode, nodes)
BUFFER(readonly, 1, PathNode, next_nodes)
BUFFER(readonly, 2, uint, queue)

void main() {
    const uint i = GLOBAL_INDEX;
    if (i >= min(params.capacity, queue[params.level])) return;
    const PathNode node = nodes[i];
    vec3 radiance = node.radiance;
    if (node.child0 < params.next_capacity) radiance += node.weight0 * next_nodes[node.child0].radiance;
    if (node.child1 < params.next_capacity) radiance += node.weight1 * next_nodes[node.child1].radiance;
    nodes[i].radiance = radiance;
}
