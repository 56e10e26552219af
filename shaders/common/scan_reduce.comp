// Prefix sum of pairs, first of three passes: the sum of each block of SCAN_BLOCK elements.
#version 460
#include "common/common.glsl"
#include "common/scan_params.h"
layout(local_size_x = 256) in;
PARAMS(ScanParams)
BUFFER(readonly, 0, uint, counters)
BUFFER(readonly, 1, uvec2, sums)
BUFFER(writeonly, 2, uvec2, block_sums)
#include "common/scan.glsl"

shared uvec2 partial[256];

void main() {
    const uint count = scanCount(), first = GROUP_INDEX * SCAN_BLOCK + gl_LocalInvocationIndex * 4u;
    uvec2 sum = uvec2(0);
    for (uint i = first; i < first + 4u; i++) sum += i < count ? sums[i] : uvec2(0);
    partial[gl_LocalInvocationIndex] = sum;
    for (uint step = 128u; step > 0u; step >>= 1u) {
        barrier();
        if (gl_LocalInvocationIndex < step) partial[gl_LocalInvocationIndex] += partial[gl_LocalInvocationIndex + step];
    }
    if (gl_LocalInvocationIndex == 0u) block_sums[GROUP_INDEX] = partial[0];
}
