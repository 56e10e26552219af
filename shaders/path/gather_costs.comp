// Adds what a level's shadow rays and the rays of its children cost to its own: from the deepest level back to the camera.
#version 460
#include "common/common.glsl"
#include "path/frame.h"
#include "path/path_params.h"
layout(local_size_x = 64) in;
PARAMS(LevelParams)
BUFFER(, 0, PeelrayCounts, costs)
BUFFER(readonly, 1, PeelrayCounts, next_costs)
BUFFER(readonly, 2, PeelrayCounts, light_costs)
BUFFER(readonly, 3, PathNode, nodes)
BUFFER(readonly, 4, PathBranches, branches)
BUFFER(readonly, 5, uint, queue)
BUFFER(readonly, 6, Frame, frame)
#include "view/camera.glsl"
#include "path/cost_sums.glsl"

void main() {
    const uint i = GLOBAL_INDEX;
    if (queue[QUEUE_OVERFLOW] != 0u || i >= params.capacity) return;
    // The camera's level has an entry for each pixel of whole tiles, some beside the picture; the others are counted.
    const uvec2 pixel = recordPixel(i, params.first_row);
    if (params.level == 0u ? pixel.x >= frame[0].width || pixel.y >= frame[0].height : i >= queue[params.level]) return;
    const PathNode node = nodes[i];
    PeelrayCounts sum = costs[i];
    for (uint k = 0u; k < (node.flags & NODE_LIGHTS); k++) sum = costSum(sum, light_costs[node.first_light + k]);
    if ((node.flags & NODE_BRANCHES) != 0u) {
        const PathBranches children = branches[i];
        if (children.child0 != NO_CHILD) sum = costSum(sum, next_costs[children.child0]);
        if (children.child2 != NO_CHILD) sum = costSum(sum, next_costs[children.child2]);
        const uint second = children.child1 >= BACKDROP_CHILD ? 0u : ((node.flags & NODE_DISPERSED) != 0u ? 3u : 1u);
        for (uint k = 0u; k < second; k++) sum = costSum(sum, next_costs[children.child1 + k]);
    }
    costs[i] = sum;
}
