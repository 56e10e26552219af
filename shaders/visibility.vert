// Primary visibility: every triangle, drawn with its index. Positions relative to the eye, reversed depth.
#version 460
#include "common.glsl"
#include "params.h"
PARAMS(VisibilityParams)
BUFFER(readonly, 0, Frame, frame)
BUFFER(readonly, 1, vec3, positions)
BUFFER(readonly, 2, uvec3, triangles)
layout(location = 0) flat out uint triangle;

void main() {
    triangle = uint(gl_VertexIndex) / 3u;
    const uvec3 corners = triangles[triangle];
    const vec3 p = positions[corners[uint(gl_VertexIndex) % 3u]] - frame[0].eye;
    const vec3 right = frame[0].right, up = frame[0].up;
    const vec2 plane = vec2(dot(p, right) / dot(right, right), dot(p, up) / dot(up, up));
    const float depth = dot(p, frame[0].forward);
    // The rasteriser samples pixel centres: moving the picture moves the sample.
    const vec2 shift = (0.5 - params.jitter) * 2.0 / vec2(frame[0].width, frame[0].height);
    if (frame[0].orthographic != 0u)
        gl_Position = vec4(plane * vec2(1, -1) + shift, (frame[0].far - depth) / frame[0].far, 1);
    else
        gl_Position = vec4(plane * vec2(1, -1) + shift * depth, frame[0].near, depth);
}
