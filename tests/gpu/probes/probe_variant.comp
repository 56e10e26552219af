// data[i] += step; with `sums` also extra[i] += data[i].
#version 460
#include "common/common.glsl"
layout(local_size_x = 64) in;
layout(constant_id = 0) const bool sums = false;
struct Add { uint count, step; };
PARAMS(Add)
BUFFER(, 0, uint, data)
BUFFER(, 1, uint, extra)

void main() {
    const uint i = gl_GlobalInvocationID.x;
    if (i >= params.count) return;
    data[i] += params.step;
    if (sums) extra[i] += data[i];
}
