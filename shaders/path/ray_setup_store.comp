// The targets of ray_setup, for the host (aov_table.h).
#version 460
#include "common/common.glsl"
#include "path/aov_records.h"
#include "path/frame.h"
layout(local_size_x = 64) in;
PARAMS(uint)  // pixels
BUFFER(readonly, 0, Frame, frame)
BUFFER(writeonly, 1, AovRaySetup, ray_setups)
IMAGE(2, texture2D, reflection)
IMAGE(3, texture2D, box_point)
IMAGE(4, texture2D, directions_xy)
IMAGE(5, texture2D, directions_z)

void main() {
    const uint i = GLOBAL_INDEX;
    if (i >= params) return;
    const ivec2 pixel = ivec2(i % frame[0].width, i / frame[0].width);
    AovRaySetup record;
    record.reflection = texelFetch(reflection, pixel, 0);
    record.box = texelFetch(box_point, pixel, 0);
    record.directions = mat2x4(texelFetch(directions_xy, pixel, 0), texelFetch(directions_z, pixel, 0));
    ray_setups[i] = record;
}
