// Primary visibility: every triangle, drawn with its index. Positions relative to the eye, reversed depth.
#version 460
#include "common.glsl"
#include "params.h"
PARAMS(VisibilityParams)
BUFFER(readonly, 0, Frame, frame)
BUFFER(readonly, 1, vec3, positions)
BUFFER(readonly, 2, uvec3, triangles)
layout(location = 0) flat out uint triangle;
#include "project.glsl"

void main() {
    triangle = uint(gl_VertexIndex) / 3u;
    const uvec3 corners = triangles[triangle];
    const vec3 p = positions[corners[uint(gl_VertexIndex) % 3u]] - frame[0].eye;
    // The rasteriser samples pixel centres: moving the picture moves the sample.
    gl_Position = project(p, (0.5 - params.jitter) * 2.0 / vec2(frame[0].width, frame[0].height));
}
