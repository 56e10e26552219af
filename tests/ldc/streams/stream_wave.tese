// Displaced after tessellation.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(quads, equal_spacing, ccw) in;
#include "ldc/ldc_stream_vertex.glsl"
#include "stream_surface.glsl"

void main() {
    const vec2 p = mix(gl_in[0].gl_Position.xy, gl_in[3].gl_Position.xy, gl_TessCoord.xy);
    gl_Position = vec4(p, surfaceHeight(p.x), 1);
    stream_id = uint(gl_in[0].gl_Position.z);
    stream_data0 = vec4(p, 0, 0);
    stream_data1 = vec4(surfaceNormal(p.x), 0);
}
