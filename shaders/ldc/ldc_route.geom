// Computes the face normal and sends the triangle into the LDI that its normal picks (the paper, section 1.2.1); in the overlap
// band into two or three.
#version 460
#include "common/common.glsl"
#include "ldc/ldc_params.h"
layout(triangles) in;
layout(triangle_strip, max_vertices = 9) out;
PARAMS(LdcParams)
BUFFER(readonly, 2, LdcCounters, counters)
BUFFER(readonly, 3, LdcBody, bodies)
#include "ldc/ldc_route.glsl"
layout(location = 0) flat in uvec2 corner_id[];

void emitAt(vec4 clip, LdcTriangle t, uint id, uint body, vec3 normal) {
    ldcHandOn(t, id, body, normal);
    gl_Position = clip;
    gl_Layer = layered ? int(id & 3u) : 0;
    EmitVertex();
}

void main() {
    const vec3 a = gl_in[0].gl_Position.xyz, b = gl_in[1].gl_Position.xyz, c = gl_in[2].gl_Position.xyz;
    const uint triangle = corner_id[0].x, body = ldcBodyOfTriangle(triangle);
    const CubeGrid grid = bodies[body].grid;
    vec3 normal;
    if (!ldcDrawn(a, b, c, grid, normal)) return;
    for (uint axis = 0u; axis < 3u; axis++) {
        if (!ldcCaptured(normal, axis, params.sampling)) continue;
        const LdcTriangle t = ldcProject(grid, a, b, c, normal, axis);
        const uint id = triangle << 2u | axis;
        if (dilated) {
            // A strip that runs to and fro between both ends of the polygon's outline.
            const LdcPolygon p = ldcGrown(t);
            for (int i = 0; i < p.count; i++) emitAt(ldcGrownClip(p, (i & 1) != 0 ? (i + 1) / 2 : (p.count - i / 2) % p.count), t, id, body, normal);
        } else {
            emitAt(ldcClip(t.a.xy), t, id, body, normal);
            emitAt(ldcClip(t.b.xy), t, id, body, normal);
            emitAt(ldcClip(t.c.xy), t, id, body, normal);
        }
        EndPrimitive();
    }
}
