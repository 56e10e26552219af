// One step of a log-step maximum: each workgroup leaves the largest of 1024 values.
#version 460
#include "common/common.glsl"
#include "ldc/ldc_params.h"
layout(local_size_x = 256) in;
PARAMS(MaxParams)
BUFFER(, 0, uint, layer_counts)

shared uint largest[256];

void main() {
    const uint lane = gl_LocalInvocationIndex, first = GROUP_INDEX * LDC_MAX_BLOCK + lane;
    uint value = 0u;
    for (uint k = 0u; k < LDC_MAX_BLOCK; k += 256u)
        if (first + k < params.count) value = max(value, layer_counts[params.from + first + k]);
    largest[lane] = value;
    for (uint step = 128u; step > 0u; step >>= 1u) {
        barrier();
        if (lane < step) largest[lane] = max(largest[lane], largest[lane + step]);
    }
    if (lane == 0u && GROUP_INDEX * LDC_MAX_BLOCK < params.count) layer_counts[params.to + GROUP_INDEX] = largest[0];
}
