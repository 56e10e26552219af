// The 64 voxel entries of each node: where a list starts, or an empty voxel's box. Queues the long lists.
#version 460
#include "ldc_common.glsl"
layout(local_size_x = 64) in;
PARAMS(LdcParams)
BUFFER(, 0, LdcCounters, counters)
BUFFER(readonly, 1, uint, voxel_counts)
BUFFER(readonly, 2, uvec2, sums)
BUFFER(writeonly, 3, uint, voxel_table)
BUFFER(writeonly, 4, uint, long_lists)

shared uint starts[64];
shared uint mask[2];

void main() {
    const uint lane = gl_LocalInvocationIndex;
    const uint count = min(counters[0].nodes, params.node_capacity);
    const uint node = GROUP_INDEX;
    if (node >= count) return;
    const uint samples = voxel_counts[node * 64u + lane];
    if (lane < 2u) mask[lane] = 0u;
    starts[lane] = samples;
    barrier();
    if (samples != 0u) atomicOr(mask[lane >> 5u], 1u << (lane & 31u));
    for (uint step = 1u; step < 64u; step <<= 1u) {
        const uint other = lane >= step ? starts[lane - step] : 0u;
        barrier();
        starts[lane] += other;
        barrier();
    }
    uint entry;
    if (samples != 0u) {
        entry = 0x80000000u | (params.first_sample + sums[node].x + starts[lane] - samples);
        if (samples > LDC_LONG_LIST) {
            const uint slot = atomicAdd(counters[0].long_lists, 1u);
            if (slot < params.long_capacity) long_lists[slot] = node * 64u + lane;
        }
        if (samples > counters[0].longest) atomicMax(counters[0].longest, samples);
    } else {
        entry = ldcGrowBox(uvec2(mask[0], mask[1]), lane);
    }
    voxel_table[(params.first_node + node) * 64u + lane] = entry;
    if (lane == 63u && node == count - 1u) counters[0].voxels = sums[node].y + ldcMaskCount(uvec2(mask[0], mask[1]));
}
