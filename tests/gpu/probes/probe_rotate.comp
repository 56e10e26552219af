// to[i] = from[i + shift] + add, around the end: every thread reads what another wrote in the pass before.
#version 460
#include "common/common.glsl"
layout(local_size_x = 64) in;
struct Rotate { uint count, shift, add; };
PARAMS(Rotate)
BUFFER(readonly, 0, uint, from)
BUFFER(writeonly, 1, uint, to)

void main() {
    const uint i = gl_GlobalInvocationID.x;
    if (i < params.count) to[i] = from[(i + params.shift) % params.count] + params.add;
}
