// The corners of all triangles for `exact` hits by voxel, where the rasteriser does not leave them.
#version 460
#include "common/common.glsl"
#include "ldc/ldc_params.h"
layout(local_size_x = 128) in;
PARAMS(LdcParams)
BUFFER(readonly, 0, vec3, positions)
BUFFER(readonly, 1, uvec3, triangles)
BUFFER(readonly, 2, LdcBody, bodies)
BUFFER_ALIGNED(writeonly, 3, LdcCorners, corners)
#include "ldc/ldc_bodies.glsl"
#include "ldc/ldc_common.glsl"
#include "ldc/ldc_corners.glsl"

void main() {
    if (GLOBAL_INDEX >= params.triangles) return;
    const uint id = params.first_triangle + GLOBAL_INDEX;
    const CubeGrid grid = bodies[ldcBodyOfTriangle(id)].grid;
    const uvec3 indices = triangles[id];
    const vec3 a = positions[indices.x], b = positions[indices.y], c = positions[indices.z];
    corners[id] = ldcPackCorners(grid, a, b, c, ldcNormal(a, b, c, grid.inv_voxel));
}
