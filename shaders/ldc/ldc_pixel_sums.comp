// What the prefix sum over the pixels adds up: samples and pixels that have any. Finds the depth complexity and the long lists.
#version 460
#include "ldc/ldc_common.glsl"
layout(local_size_x = 256) in;
PARAMS(LdcParams)
BUFFER(, 0, LdcCounters, counters)
BUFFER(readonly, 1, uint, pixel_counts)
BUFFER(writeonly, 2, uvec2, sums)
BUFFER(writeonly, 3, uint, long_lists)

shared uint longest;

void main() {
    if (!LDC_FITS(counters[0])) return;
    if (gl_LocalInvocationIndex == 0u) longest = 0u;
    barrier();
    const uint i = GLOBAL_INDEX;
    if (i < counters[0].cells) {
        const uint count = pixel_counts[i];
        sums[i] = uvec2(count, min(count, 1u));
        if (count != 0u) atomicMax(longest, count);
        if (count > LDC_LONG_LIST) {
            const uint slot = atomicAdd(counters[0].long_lists, 1u);
            if (slot < params.long_capacity) long_lists[slot] = i;
        }
    }
    barrier();
    if (gl_LocalInvocationIndex == 0u && longest != 0u) atomicMax(counters[0].longest, longest);
}
