// Splits the queued large triangles into the 16x16-pixel tiles that they touch: one workgroup per triangle.
#version 460
#include "common.glsl"
#include "params.h"
layout(local_size_x = 64) in;
PARAMS(LdcParams)
BUFFER(readonly, 0, vec3, positions)
BUFFER(readonly, 1, uvec3, triangles)
BUFFER(, 2, LdcCounters, counters)
BUFFER(readonly, 3, uint, big_triangles)
BUFFER(writeonly, 4, uvec2, tiles)
BUFFER(readonly, 5, LdcBody, bodies)
#include "ldc_bodies.glsl"
#include "ldc_common.glsl"
#include "ldc_projected.glsl"

void main() {
    const uint count = min(counters[0].big, params.big_capacity);
    if (GROUP_INDEX >= count) return;
    const uint id = big_triangles[GROUP_INDEX];
    const CubeGrid grid = bodies[ldcBodyOfTriangle(id >> 2u)].grid;
    const LdcTriangle t = ldcProjected(grid, id);
    const vec3 reach = ldcReach(t);
    ivec2 lo, hi;
    ldcBounds(t, uvec3(peelrayToLdi(vec3(grid.dims), id & 3u)).xy, lo, hi);
    const uvec2 first = uvec2(lo) >> 4u, size = (uvec2(hi) >> 4u) - first + 1u;
    for (uint j = gl_LocalInvocationIndex; j < size.x * size.y; j += gl_WorkGroupSize.x) {
        const uvec2 tile = first + uvec2(j % size.x, j / size.x);
        // Half a tile and a pixel: never tighter than the test of the pixels themselves.
        if (any(lessThan(ldcEdges(t, vec2(tile) * 16.0 + 8.0), -8.51 * reach))) continue;
        const uint slot = atomicAdd(counters[0].tiles, 1u);
        if (slot < params.tile_capacity) tiles[slot] = uvec2(id, tile.x | tile.y << 16u);
    }
}
