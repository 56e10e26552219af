// One more level of the min/max pyramid (`--traversal mipmap`): a cell covers 2 x 2 of the level below. One thread per cell.
#version 460
#include "common/common.glsl"
#include "ldc/ldc_params.h"
layout(local_size_x = 64) in;
PARAMS(LdcParams)
BUFFER(readonly, 0, LdcCounters, counters)
BUFFER(readonly, 1, LdcBody, bodies)
BUFFER(, 2, vec2, pixel_ranges)
#include "ldc/ldc_ranges.glsl"

void main() {
    if (!LDC_FITS(counters[0])) return;
    // Up to 16 x 16 pixels all sizes divide; beyond, a thread for as many pixels is more than enough.
    const uint shift = min(2u * params.level, 8u), i = GLOBAL_INDEX << shift;
    LdcImage image;
    if (i >= counters[0].cells || !ldcImageOf(i, image)) return;
    const uint index = (params.first_cell + i - image.first) >> shift;
    const uvec2 below = peelrayLevelSize(image.size, params.level - 1u), size = peelrayLevelSize(image.size, params.level);
    if (index >= size.x * size.y) return;
    uint first = image.first / 2u;
    for (uint level = 1u; level + 1u < params.level; level++) {
        const uvec2 level_size = peelrayLevelSize(image.size, level);
        first += level_size.x * level_size.y;
    }
    const uvec2 from = uvec2(index % size.x, index / size.x) * 2u, to = min(from + 2u, below);
    vec2 range = vec2(1e30, -1e30);
    for (uint y = from.y; y < to.y; y++)
        for (uint x = from.x; x < to.x; x++) {
            const vec2 part = pixel_ranges[first + y * below.x + x];
            range = vec2(min(range.x, part.x), max(range.y, part.y));
        }
    pixel_ranges[first + below.x * below.y + index] = range;
}
