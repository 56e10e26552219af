// Workgroups for a level's passes, from the length of its queue, and behind those of all levels the rays themselves. None if it did not fit, and none for what is left to do for
// the level before it: everything is done again then.
#version 460
#include "common.glsl"
#include "params.h"
layout(local_size_x = 1) in;
PARAMS(LevelParams)
BUFFER(readonly, 0, uint, queue)
BUFFER(writeonly, 1, uvec3, groups)

void main() {
    const bool fits = queue[QUEUE_OVERFLOW] == 0u;
    const uint rays = fits ? min(params.capacity, queue[params.level]) : 0u;
    const uint count = (rays + 63u) / 64u;
    groups[params.level] = uvec3(min(count, DISPATCH_ROW), (count + DISPATCH_ROW - 1u) / DISPATCH_ROW, 1u);
    groups[QUEUE_LEVELS + params.level] = uvec3(rays, 1u, 1u);
    if (!fits && params.level > 0u) groups[params.level - 1u].x = groups[QUEUE_LEVELS + params.level - 1u].x = 0u;
}
