// The triangles of copies, which never change: indices, and whose they are.
#version 460
#include "common/common.glsl"
#include "ldc/merge_params.h"
layout(local_size_x = 64) in;
PARAMS(MergeParams)
BUFFER(readonly, 0, MergedInstance, merged)
BUFFER_ALIGNED(readonly, 1, uvec2, groups)  // of a workgroup: the instance's number, its first triangle
BUFFER(, 2, uvec3, triangles)
BUFFER_ALIGNED(writeonly, 3, uvec2, copied)

void main() {
    if (GROUP_INDEX >= params.groups) return;
    const MergedInstance own = merged[groups[GROUP_INDEX].x];
    const uint triangle = groups[GROUP_INDEX].y + gl_LocalInvocationIndex;
    if (triangle >= own.triangles) return;
    const uint place = own.triangle + triangle, original = own.body_triangle + triangle;
    triangles[place] = triangles[original] - own.body_vertex + own.vertex;
    copied[place - params.first_copy] = uvec2(own.instance, original);
}
