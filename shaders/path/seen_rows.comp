// How much is seen in each row of the picture: the sum of its pixels' alphas.
#version 460
#include "common/common.glsl"
layout(local_size_x = 64) in;
PARAMS(uvec2)  // the picture's size
BUFFER(readonly, 0, vec4, picture)
BUFFER(writeonly, 1, float, rows)
shared float parts[64];

void main() {
    const uint row = GROUP_INDEX;
    if (row >= params.y) return;
    float sum = 0.0;
    for (uint x = gl_LocalInvocationIndex; x < params.x; x += 64u) sum += picture[row * params.x + x].w;
    parts[gl_LocalInvocationIndex] = sum;
    barrier();
    if (gl_LocalInvocationIndex != 0u) return;
    for (uint i = 1u; i < 64u; i++) sum += parts[i];
    rows[row] = sum;
}
