// Adds a band's pixels to the picture's sums; not if a queue overflowed, for then the band is done again.
#version 460
#include "common.glsl"
#include "params.h"
layout(local_size_x = 64) in;
PARAMS(LevelParams)
BUFFER(readonly, 0, Frame, frame)
BUFFER(readonly, 1, PathNode, nodes)
BUFFER(readonly, 2, Hit, hits)
BUFFER(readonly, 3, uint, queue)
BUFFER(, 4, vec4, picture)
#include "camera.glsl"

void main() {
    const uint i = GLOBAL_INDEX;
    if (i >= params.capacity || queue[QUEUE_OVERFLOW] != 0u) return;
    const uvec2 pixel = recordPixel(i, params.first_row);
    if (pixel.x >= frame[0].width || pixel.y >= frame[0].height) return;
    const uint at = pixel.y * frame[0].width + pixel.x;
    const vec4 before = params.sample_index == 0u ? vec4(0) : picture[at];
    const vec3 radiance = nodes[i].radiance;
    // One bad number must not poison a pixel for good.
    const bool finite = radiance.r < 1e30 && radiance.g < 1e30 && radiance.b < 1e30 && radiance.r >= 0.0 && radiance.g >= 0.0 && radiance.b >= 0.0;
    picture[at] = before + vec4(finite ? radiance : vec3(0), hits[i].triangle != NO_TRIANGLE ? 1.0 : 0.0);
}
