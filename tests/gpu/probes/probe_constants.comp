// data[i] += step * factor + offset, with `twice` two times that: the constants' numbers are in no order.
#version 460
#include "common/common.glsl"
layout(local_size_x = 64) in;
layout(constant_id = 7) const uint factor = 1;
layout(constant_id = 2) const uint offset = 0;
layout(constant_id = 4) const bool twice = false;
layout(constant_id = 0) const uint unused = 0;
struct Add { uint count, step; };
PARAMS(Add)
BUFFER(, 0, uint, data)

void main() {
    const uint i = gl_GlobalInvocationID.x;
    const uint more = params.step * factor + offset;
    if (i < params.count) data[i] += twice ? 2u * more : more;
}
