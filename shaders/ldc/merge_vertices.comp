// The vertices of copies, in the world, where their instances stand now; the bounds of the body that they share.
#version 460
#include "common/common.glsl"
#include "common/instance.h"
#include "ldc/merge_params.h"
layout(local_size_x = 64) in;
PARAMS(MergeParams)
BUFFER(readonly, 0, MergedInstance, merged)
BUFFER_ALIGNED(readonly, 1, uvec2, groups)  // of a workgroup: the instance's number, its first vertex
BUFFER(readonly, 2, GpuTransform, transforms)
BUFFER(, 3, vec3, positions)
BUFFER(, 4, uvec3, body_lower)
BUFFER(, 5, uvec3, body_upper)
#include "common/grow_bounds.glsl"

void main() {
    if (GROUP_INDEX >= params.groups) return;
    const MergedInstance own = merged[groups[GROUP_INDEX].x];
    const uint vertex = groups[GROUP_INDEX].y + gl_LocalInvocationIndex;
    const bool valid = vertex < own.vertices;
    vec3 position = vec3(0);
    if (valid) {
        const GpuTransform to_world = transforms[own.instance];
        position = to_world.linear * positions[own.body_vertex + vertex] + to_world.position;
        positions[own.vertex + vertex] = position;
    }
    growBounds(params.body, position, valid);
}
