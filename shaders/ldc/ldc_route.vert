// Corners of triangles, fetched by number. Without a geometry shader each fetches all three, computes the normal, and throws
// away what the LDI of this instance does not capture.
#version 460
#include "common/common.glsl"
#include "ldc/ldc_params.h"
PARAMS(LdcParams)
BUFFER(readonly, 0, vec3, positions)
BUFFER(readonly, 1, uvec3, triangles)
BUFFER(readonly, 2, LdcCounters, counters)
BUFFER(readonly, 3, LdcBody, bodies)
#include "ldc/ldc_route.glsl"

void main() {
    // Five triangles of three corners make seven sides.
    const uint corners = dilated && !by_geometry ? 15u : 3u;
    const uint id = params.first_triangle + uint(gl_VertexIndex) / corners, k = uint(gl_VertexIndex) % corners;
    const uvec3 numbers = triangles[id];
    if (by_geometry) {
        routed_id = uvec2(id, 0);
        gl_Position = vec4(positions[numbers[k]], 1);
        return;
    }
    const uint axis = uint(gl_InstanceIndex), body = ldcBodyOfTriangle(id);
    const CubeGrid grid = bodies[body].grid;
    const vec3 a = positions[numbers.x], b = positions[numbers.y], c = positions[numbers.z];
    vec3 normal;
    gl_Position = LDC_NOWHERE;
    if (!ldcDrawn(a, b, c, grid, normal) || !ldcCaptured(normal, axis, params.sampling)) return;
    const LdcTriangle t = ldcProject(grid, a, b, c, normal, axis);
    ldcHandOn(t, id << 2u | axis, body, normal);
    if (dilated) {
        const LdcPolygon p = ldcGrown(t);
        gl_Position = ldcGrownClip(p, k % 3u == 0u ? 0 : int(k / 3u + k % 3u));
    } else {
        gl_Position = ldcClip(k == 0u ? t.a.xy : (k == 1u ? t.b.xy : t.c.xy));
    }
}
