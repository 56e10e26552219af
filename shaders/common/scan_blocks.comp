// Prefix sum of pairs, second pass: one workgroup turns the block sums into exclusive prefix sums and adds their total at the end.
#version 460
#include "common/common.glsl"
#include "common/scan_params.h"
layout(local_size_x = 256) in;
PARAMS(ScanParams)
BUFFER(, 0, uvec2, block_sums)

shared uvec2 partial[256];

void main() {
    const uint lane = gl_LocalInvocationIndex;
    const uint blocks = (params.capacity + SCAN_BLOCK - 1u) / SCAN_BLOCK;
    uvec2 carry = uvec2(0);
    for (uint base = 0u; base < blocks; base += 256u) {
        const uvec2 value = base + lane < blocks ? block_sums[base + lane] : uvec2(0);
        partial[lane] = value;
        barrier();
        for (uint step = 1u; step < 256u; step <<= 1u) {
            const uvec2 other = lane >= step ? partial[lane - step] : uvec2(0);
            barrier();
            partial[lane] += other;
            barrier();
        }
        if (base + lane < blocks) block_sums[base + lane] = carry + partial[lane] - value;
        carry += partial[255];
        barrier();
    }
    if (lane == 0u) block_sums[blocks] = carry;
}
