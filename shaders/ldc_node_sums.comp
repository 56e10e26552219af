// Samples and occupied voxels of each node: input of the second prefix sum.
#version 460
#include "ldc_common.glsl"
layout(local_size_x = 64) in;
PARAMS(LdcParams)
BUFFER(readonly, 0, LdcCounters, counters)
BUFFER(readonly, 1, uint, voxel_counts)
BUFFER(writeonly, 2, uvec2, sums)

shared uvec2 partial[64];

void main() {
    const uint lane = gl_LocalInvocationIndex;
    const uint count = min(counters[0].nodes, params.node_capacity);
    const uint node = GROUP_INDEX;
    if (node >= count) return;
    const uint samples = voxel_counts[node * 64u + lane];
    partial[lane] = uvec2(samples, samples != 0u ? 1u : 0u);
    for (uint step = 32u; step > 0u; step >>= 1u) {
        barrier();
        if (lane < step) partial[lane] += partial[lane + step];
    }
    if (lane == 0u) sums[node] = partial[0];
}
