// Counts the triangles that have no area or corners that are not finite: the graphics pipeline drops them silently.
#version 460
#include "ldc/ldc_common.glsl"
layout(local_size_x = 64) in;
PARAMS(LdcParams)
BUFFER(readonly, 0, vec3, positions)
BUFFER(readonly, 1, uvec3, triangles)
BUFFER(, 2, LdcCounters, counters)
BUFFER(readonly, 3, LdcBody, bodies)
#include "common/bounds.glsl"
#include "ldc/ldc_bodies.glsl"

void main() {
    if (GLOBAL_INDEX >= params.triangles) return;
    const uint id = params.first_triangle + GLOBAL_INDEX;
    const uvec3 corners = triangles[id];
    const vec3 a = positions[corners.x], b = positions[corners.y], c = positions[corners.z];
    if (!(isBounded(a) && isBounded(b) && isBounded(c)))
        atomicAdd(counters[0].invalid, 1u);
    else if (ldcNormal(a, b, c, bodies[ldcBodyOfTriangle(id)].grid.inv_voxel) == vec3(0))
        atomicAdd(counters[0].degenerate, 1u);
}
