// Workgroups for a level's passes, from the length of its queue.
#version 460
#include "common.glsl"
#include "params.h"
layout(local_size_x = 1) in;
PARAMS(LevelParams)
BUFFER(readonly, 0, uint, queue)
BUFFER(writeonly, 1, uvec3, groups)

void main() { 
    const uint count = (min(params.capacity, queue[params.level]) + 63u) / 64u;
    groups[params.level] = uvec3(min(count, DISPATCH_ROW), (count + DISPATCH_ROW - 1u) / DISPATCH_ROW, 1u);
}
