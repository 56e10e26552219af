// Prefix sum of pairs, third pass: each element becomes the sum of all before it.
#version 460
#include "common/common.glsl"
#include "common/scan_params.h"
layout(local_size_x = 256) in;
PARAMS(ScanParams)
BUFFER(readonly, 0, uint, counters)
BUFFER(, 1, uvec2, sums)
BUFFER(readonly, 2, uvec2, block_sums)
#include "common/scan.glsl"

shared uvec2 partial[256];

void main() {
    const uint lane = gl_LocalInvocationIndex;
    const uint count = scanCount(), first = GROUP_INDEX * SCAN_BLOCK + lane * 4u;
    uvec2 values[4];
    uvec2 sum = uvec2(0);
    for (uint i = 0u; i < 4u; i++) {
        values[i] = first + i < count ? sums[first + i] : uvec2(0);
        sum += values[i];
    }
    partial[lane] = sum;
    barrier();
    for (uint step = 1u; step < 256u; step <<= 1u) {
        const uvec2 other = lane >= step ? partial[lane - step] : uvec2(0);
        barrier();
        partial[lane] += other;
        barrier();
    }
    uvec2 before = block_sums[GROUP_INDEX] + partial[lane] - sum;
    for (uint i = 0u; i < 4u; i++) {
        if (first + i < count) sums[first + i] = before;
        before += values[i];
    }
}
