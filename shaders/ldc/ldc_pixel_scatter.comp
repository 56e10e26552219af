// Puts every fragment's number into its pixel's list, in the order in which the atomics happened to run.
#version 460
#include "ldc/ldc_common.glsl"
layout(local_size_x = 128) in;
PARAMS(LdcParams)
BUFFER(readonly, 0, LdcCounters, counters)
BUFFER(readonly, 1, LdcFragment, fragments)
BUFFER(readonly, 2, uint, slots)
BUFFER(readonly, 3, uvec2, sums)
BUFFER(writeonly, 4, uint, unsorted_ids)

void main() {
    if (!LDC_FITS(counters[0])) return;
    const uint i = GLOBAL_INDEX;
    if (i >= min(counters[0].fragments, params.fragment_capacity)) return;
    unsorted_ids[sums[fragments[i].cell].x + slots[i]] = i;
}
