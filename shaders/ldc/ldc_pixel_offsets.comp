// Where each pixel's list begins among the samples.
#version 460
#include "ldc/ldc_common.glsl"
layout(local_size_x = 256) in;
PARAMS(LdcParams)
BUFFER(, 0, LdcCounters, counters)
BUFFER(readonly, 1, uvec2, sums)
BUFFER(writeonly, 2, uint, pixel_offsets)

void main() {
    if (!LDC_FITS(counters[0])) return;
    const uint i = GLOBAL_INDEX;
    if (i >= counters[0].cells) return;
    pixel_offsets[params.first_cell + i] = params.first_sample + sums[i].x;
    // The last entries are not pixels and have no samples: the sum before them is the total.
    if (i + 1u == counters[0].cells) counters[0].voxels = sums[i].y;
}
