// Sorts the short lists by depth, and by id where depths are equal: each fragment counts those before it. Writes the samples.
#version 460
#include "ldc/ldc_common.glsl"
layout(local_size_x = 128) in;
layout(constant_id = 0) const bool streams = false;
PARAMS(LdcParams)
BUFFER(readonly, 0, LdcCounters, counters)
BUFFER(readonly, 1, LdcFragment, fragments)
BUFFER(readonly, 2, uint, pixel_counts)
BUFFER(readonly, 3, uvec2, sums)
BUFFER(readonly, 4, uint, unsorted_ids)
BUFFER(readonly, 5, vec3, positions)
BUFFER(readonly, 6, uvec3, triangles)
BUFFER(readonly, 7, LdcBody, bodies)
BUFFER(writeonly, 8, uvec2, samples)
BUFFER(writeonly, 9, uint, sample_ids)
BUFFER(readonly, 10, LdcCaptured, captured)
BUFFER(writeonly, 11, uvec2, sample_attributes)
#include "ldc/ldc_bodies.glsl"
#include "ldc/ldc_pixel_place.glsl"

void main() {
    if (!LDC_FITS(counters[0])) return;
    const uint i = GLOBAL_INDEX;
    if (i >= min(counters[0].fragments, params.fragment_capacity)) return;
    const LdcFragment f = fragments[i];
    const uint length = pixel_counts[f.cell];
    if (length > LDC_LONG_LIST) return;
    const uint start = sums[f.cell].x;
    const float w = uintBitsToFloat(f.local);
    uint rank = 0u;
    for (uint j = start; j < start + length; j++) {
        const LdcFragment other = fragments[unsorted_ids[j]];
        const float other_w = uintBitsToFloat(other.local);
        rank += other_w < w || (other_w == w && other.id < f.id) ? 1u : 0u;
    }
    placePixelSample(start + rank, i);
}
