// The coarse level of the paper's section 1.3: over each block of n x m pixels the least and greatest depth that a hit on one of
// its samples can have. One thread per block.
#version 460
#include "common/common.glsl"
#include "ldc/ldc_params.h"
layout(local_size_x = 64) in;
PARAMS(LdcParams)
BUFFER(readonly, 0, LdcCounters, counters)
BUFFER(readonly, 1, LdcBody, bodies)
BUFFER(readonly, 2, uint, pixel_offsets)
BUFFER(readonly, 3, uvec2, samples)
BUFFER(writeonly, 4, vec2, pixel_ranges)
#include "ldc/ldc_ranges.glsl"

// Of lists longer than this the first and the last sample bound all others' patches.
const uint SHORT = 16u;

/// How far from its depth at the centre a hit on a sample may lie.
float reachOf(uint slopes, float tolerance) {
    const vec2 slope = abs(unpackSnorm2x16(slopes)) * PEELRAY_SLOPE_RANGE;
    if (params.sampling == LDC_CENTRE) return tolerance;
    return (params.sampling == LDC_CONSERVATIVE ? 0.5 : PEELRAY_FOOTPRINT) * (slope.x + slope.y);
}

void main() {
    if (!LDC_FITS(counters[0]) || counters[0].fragments > params.fragment_capacity) return;
    const uint i = GLOBAL_INDEX * 4u;  // a block has at least four pixels
    LdcImage image;
    if (i >= counters[0].cells || !ldcImageOf(i, image)) return;
    const uvec2 block = uvec2(params.block & 0xffffu, params.block >> 16u), blocks = (image.size + block - 1u) / block;
    const uint index = (params.first_cell + i - image.first) / 4u;
    if (index >= blocks.x * blocks.y) return;
    const uvec2 from = uvec2(index % blocks.x, index / blocks.x) * block, to = min(from + block, image.size);
    vec2 range = vec2(1e30, -1e30);
    for (uint y = from.y; y < to.y; y++)
        for (uint x = from.x; x < to.x; x++) {
            const uint pixel = image.first + peelrayPixelIndex(uvec2(x, y), image.size.x);
            const uint begin = pixel_offsets[pixel], end = pixel_offsets[pixel + 1u];
            if (end - begin > SHORT) {
                const float most = reachOf(packSnorm2x16(vec2(1)), image.tolerance);
                range = vec2(min(range.x, uintBitsToFloat(samples[begin].x) - most), max(range.y, uintBitsToFloat(samples[end - 1u].x) + most));
                continue;
            }
            for (uint j = begin; j < end; j++) {
                const uvec2 data = samples[j];
                const float w = uintBitsToFloat(data.x), reach = reachOf(data.y, image.tolerance);
                range = vec2(min(range.x, w - reach), max(range.y, w + reach));
            }
        }
    pixel_ranges[image.first / 2u + index] = range;
}
