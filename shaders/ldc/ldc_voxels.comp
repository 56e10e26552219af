// The 64 voxel entries of each node: where a list starts, or an empty voxel's box. Lists lie in the order in which the workgroups
// happen to run. Long ones are queued for ldc_refine.
#version 460
#include "ldc/ldc_common.glsl"
layout(local_size_x = 256) in;
PARAMS(LdcParams)
BUFFER(, 0, LdcCounters, counters)
BUFFER(readonly, 1, uint, voxel_counts)
BUFFER(writeonly, 2, uint, voxel_table)
BUFFER(writeonly, 3, uint, refine_queue)

shared uint masks[8];  // of four nodes
shared uint group_samples, group_voxels, group_longest, first_sample;
shared uint group_refine, first_refine, group_left;

void main() {
    const uint lane = gl_LocalInvocationIndex, voxel = lane & 63u, node = GROUP_INDEX * 4u + (lane >> 6u);
    const bool valid = node < min(counters[0].nodes, params.node_capacity);
    if (lane < 8u) masks[lane] = 0u;
    if (lane == 0u) group_samples = group_voxels = group_longest = group_refine = group_left = 0u;
    barrier();
    const uint samples = valid ? voxel_counts[node * 64u + voxel] : 0u;
    const bool refines = samples > params.refine_above && samples <= LDC_LONGEST_REFINED;
    uint start = 0u, place = 0u;
    if (samples != 0u) {
        atomicOr(masks[lane >> 5u], 1u << (lane & 31u));
        start = atomicAdd(group_samples, samples);
        atomicAdd(group_voxels, 1u);
        atomicMax(group_longest, samples);
        if (refines)
            place = atomicAdd(group_refine, 1u);
        else
            atomicMax(group_left, samples);
    }
    barrier();
    if (lane == 0u && group_samples != 0u) {
        first_sample = atomicAdd(counters[0].listed, group_samples);
        atomicAdd(counters[0].voxels, group_voxels);
        if (group_longest > counters[0].longest) atomicMax(counters[0].longest, group_longest);
        if (group_left > counters[0].longest_left) atomicMax(counters[0].longest_left, group_left);
        if (group_refine != 0u) first_refine = atomicAdd(counters[0].refine, group_refine);
    }
    barrier();
    if (!valid) return;
    if (refines) {
        place += first_refine;
        if (place < params.refine_capacity) refine_queue[place] = node * 64u + voxel;
    }
    const uvec2 mask = uvec2(masks[lane >> 6u << 1u], masks[lane >> 6u << 1u | 1u]);
    voxel_table[(params.first_node + node) * 64u + voxel] =
        samples != 0u ? 0x80000000u | (params.first_sample + first_sample + start) : ldcGrowBox(mask, voxel);
}
