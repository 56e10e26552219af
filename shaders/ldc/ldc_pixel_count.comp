// Counts each fragment in its pixel: the by-pixel order's first pass.
#version 460
#include "ldc/ldc_common.glsl"
layout(local_size_x = 128) in;
PARAMS(LdcParams)
BUFFER(readonly, 0, LdcCounters, counters)
BUFFER(readonly, 1, LdcFragment, fragments)
BUFFER(, 2, uint, pixel_counts)
BUFFER(writeonly, 3, uint, slots)

void main() {
    if (!LDC_FITS(counters[0])) return;
    const uint i = GLOBAL_INDEX;
    if (i >= min(counters[0].fragments, params.fragment_capacity)) return;
    slots[i] = atomicAdd(pixel_counts[fragments[i].cell], 1u);
}
