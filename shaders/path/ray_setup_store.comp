// The targets of ray_setup, for the host: four vec4 per pixel.
#version 460
#include "common/common.glsl"
#include "path/frame.h"
layout(local_size_x = 64) in;
PARAMS(uint)  // pixels
BUFFER(readonly, 0, Frame, frame)
BUFFER(writeonly, 1, vec4, ray_setups)
IMAGE(2, texture2D, reflection)
IMAGE(3, texture2D, box_point)
IMAGE(4, texture2D, directions_xy)
IMAGE(5, texture2D, directions_z)

void main() {
    const uint i = GLOBAL_INDEX;
    if (i >= params) return;
    const ivec2 pixel = ivec2(i % frame[0].width, i / frame[0].width);
    ray_setups[4u * i] = texelFetch(reflection, pixel, 0);
    ray_setups[4u * i + 1u] = texelFetch(box_point, pixel, 0);
    ray_setups[4u * i + 2u] = texelFetch(directions_xy, pixel, 0);
    ray_setups[4u * i + 3u] = texelFetch(directions_z, pixel, 0);
}
