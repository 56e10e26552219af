// A ribbon per instance, displaced in the vertex stage: sixteen pieces of two triangles each; places come from a buffer.
#version 460
#include "common/common.glsl"
BUFFER(readonly, 8, vec2, places)
#include "ldc/ldc_stream_vertex.glsl"
#include "stream_surface.glsl"

void main() {
    const uint piece = uint(gl_VertexIndex) / 6u, k = uint(gl_VertexIndex) % 6u;
    const uint side = k == 0u || k == 3u || k == 1u ? 0u : 1u, along = k == 0u || k == 3u || k == 5u ? 0u : 1u;
    const vec2 place = places[gl_InstanceIndex];
    const float x = -1.0 + float(piece + along) / 8.0;
    gl_Position = vec4(x, place.x + surfaceHeight(x), place.y + 0.2 * float(side), 1);
    stream_id = 1000u + uint(gl_InstanceIndex);
    stream_data0 = vec4(x, 0, 1, 0);
    stream_data1 = vec4(surfaceNormal(x).xzy, 0);
}
