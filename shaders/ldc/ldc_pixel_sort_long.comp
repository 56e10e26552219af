// Sorts the long lists by depth, then id: one workgroup per list, eight rounds of a radix sort; then the samples are written.
#version 460
#include "ldc/ldc_common.glsl"
layout(local_size_x = 256) in;
layout(constant_id = 0) const bool streams = false;
PARAMS(LdcParams)
BUFFER(readonly, 0, LdcCounters, counters)
BUFFER(readonly, 1, LdcFragment, fragments)
BUFFER(readonly, 2, uint, pixel_counts)
BUFFER(readonly, 3, uvec2, sums)
BUFFER(readonly, 4, uint, long_lists)
BUFFER(readonly, 5, vec3, positions)
BUFFER(readonly, 6, uvec3, triangles)
BUFFER(readonly, 7, LdcBody, bodies)
BUFFER(writeonly, 8, uvec2, samples)
BUFFER(, 9, uint, sample_ids)
BUFFER(, 10, uint, unsorted_ids)
BUFFER(readonly, 11, LdcCaptured, captured)
BUFFER(writeonly, 12, uvec2, sample_attributes)
#include "common/bounds.glsl"
#include "ldc/ldc_bodies.glsl"
#include "ldc/ldc_pixel_place.glsl"

/// Values are numbers of fragments; depths are the more significant half of their keys.
uint radixDigit(uint fragment, uint round) {
    const uint key = round < 4u ? fragments[fragment].id : orderedBits(uintBitsToFloat(fragments[fragment].local));
    return key >> 8u * (round & 3u) & 255u;
}
#include "ldc/ldc_radix.glsl"

void main() {
    if (!LDC_FITS(counters[0])) return;
    // Fragments that found no room are missing from the lists: everything is redone.
    if (counters[0].fragments > params.fragment_capacity) return;
    if (GROUP_INDEX >= min(counters[0].long_lists, params.long_capacity)) return;
    const uint pixel = long_lists[GROUP_INDEX], length = pixel_counts[pixel], start = sums[pixel].x;
    for (uint round = 0u; round < 8u; round++) radixRound(start, length, round, (round & 1u) == 0u);
    for (uint j = gl_LocalInvocationIndex; j < length; j += 256u) placePixelSample(start + j, unsorted_ids[start + j]);
}
