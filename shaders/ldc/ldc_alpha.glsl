// The alpha test of a cube's samples. Include after the buffer positions and what material.glsl needs.
#ifndef PEELRAY_LDC_ALPHA_GLSL
#define PEELRAY_LDC_ALPHA_GLSL

#include "common/material.glsl"
#include "ldc/ldc_common.glsl"

/// Does the triangle have a surface above the place (u, v) of its LDI? `id`: triangle * 4 + axis. Beside the triangle
/// its nearest weights count.
bool ldcPresent(CubeGrid grid, uint id, vec2 place) {
    const uint triangle = id >> 2u, axis = id & 3u;
    if (!alphaMasked(triangle)) return true;
    const uvec3 corners = triangles[triangle];
    const vec2 a = peelrayToLdi((positions[corners.x] - grid.origin) * grid.inv_voxel, axis).xy;
    const vec2 e = peelrayToLdi((positions[corners.y] - grid.origin) * grid.inv_voxel, axis).xy - a;
    const vec2 f = peelrayToLdi((positions[corners.z] - grid.origin) * grid.inv_voxel, axis).xy - a;
    const vec2 p = place - a;
    const vec2 weights = max(vec2(p.x * f.y - p.y * f.x, e.x * p.y - e.y * p.x) / (e.x * f.y - e.y * f.x), vec2(0));
    return alphaPresent(triangle, weights / max(1.0, weights.x + weights.y));
}

#endif
