// data[i] += step, in place.
#version 460
#include "common/common.glsl"
layout(local_size_x = 64) in;
layout(constant_id = 0) const uint factor = 1;
struct Add { uint count, step; };
PARAMS(Add)
BUFFER(, 0, uint, data)

void main() {
    const uint i = gl_GlobalInvocationID.x;
    if (i < params.count) data[i] += params.step * factor;
}
