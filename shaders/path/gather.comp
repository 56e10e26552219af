// Adds the light of a level's children to its nodes: from the deepest level back to the first after the camera's.
#version 460
#include "common/common.glsl"
#include "path/path_params.h"
layout(local_size_x = 64) in;
PARAMS(LevelParams)
BUFFER(, 0, PathNode, nodes)
BUFFER(readonly, 1, PathBranches, branches)
BUFFER(readonly, 2, PathNode, next_nodes)
BUFFER(readonly, 3, vec3, shadow_light)
BUFFER(readonly, 4, uint, queue)
#include "path/gather.glsl"

void main() {
    const uint i = GLOBAL_INDEX;
    if (queue[QUEUE_OVERFLOW] != 0u || i >= min(params.capacity, queue[params.level])) return;
    const PathNode node = nodes[i];
    if ((node.flags & NODE_CATCHER) != 0u) nodes[i] = caughtNode(i, node);
    if ((node.flags & NODE_CATCHER) != 0u || (node.flags & NODE_BRANCHES) == 0u) return;
    const float through = backdropShare(i, node);
    if (through == 0.0) {
        nodes[i].radiance = node.radiance + childrenRadiance(i, node);
        return;
    }
    // The place of its lights is needed for the share: their light is added here.
    nodes[i] = PathNode(litRadiance(node) + childrenRadiance(i, node), floatBitsToUint(through), (node.flags & ~NODE_LIGHTS) | NODE_BACKDROP);
}
