// Sends triangles of a drawn stream into the LDIs that capture them: ldc_route.geom for what comes from the stream's own vertex or
// tessellation shader (ldc_stream_vertex.glsl).
#version 460
#include "common/common.glsl"
#include "ldc/ldc_params.h"
layout(triangles) in;
layout(triangle_strip, max_vertices = 9) out;
PARAMS(LdcParams)
BUFFER(readonly, 2, LdcCounters, counters)
BUFFER(readonly, 3, LdcBody, bodies)
#include "ldc/ldc_route.glsl"
layout(location = 0) flat in uint stream_id[];
layout(location = 1) in vec4 stream_data0[];
layout(location = 2) in vec4 stream_data1[];
layout(location = 6) out vec4 routed_data0;
layout(location = 7) out vec4 routed_data1;

void main() {
    const vec3 a = gl_in[0].gl_Position.xyz, b = gl_in[1].gl_Position.xyz, c = gl_in[2].gl_Position.xyz;
    const uint body = params.first_body;
    const CubeGrid grid = bodies[body].grid;
    vec3 normal;
    if (!ldcDrawn(a, b, c, grid, normal)) return;
    for (uint axis = 0u; axis < 3u; axis++) {
        if (!ldcCaptured(normal, axis, params.sampling)) continue;
        const LdcTriangle t = ldcProject(grid, a, b, c, normal, axis);
        for (int k = 0; k < 3; k++) {
            ldcHandOn(t, stream_id[0] << 2u | axis, body, normal);
            routed_data0 = stream_data0[k];
            routed_data1 = stream_data1[k];
            gl_Position = ldcClip(peelrayToLdi((gl_in[k].gl_Position.xyz - grid.origin) * grid.inv_voxel, axis).xy);
            EmitVertex();
        }
        EndPrimitive();
    }
}
