// Exposure, tone curve and sRGB encoding of the finished picture.
#version 460
#include "common.glsl"
#include "params.h"
#include "shading.glsl"
layout(local_size_x = 64) in;
PARAMS(TonemapParams)
BUFFER(readonly, 0, vec4, picture)
BUFFER(writeonly, 1, uint, encoded)

void main() {
    const uint i = GLOBAL_INDEX;
    if (i >= params.pixels) return;
    vec3 color = picture[i].rgb * params.scale;
    if (params.curve == 1u) color = tonemapAces(color);
    if (params.curve == 2u) color = tonemapNeutral(color);
    encoded[i] = packUnorm4x8(vec4(linearToSrgb(clamp(color, vec3(0), vec3(1))), 1));
}
