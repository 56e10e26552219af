// Rasterises the blocks of large triangles: one workgroup per block, up to four pixels per thread.
#version 460
#include "common/common.glsl"
#include "ldc/ldc_params.h"
layout(local_size_x = 256) in;
layout(constant_id = 0) const bool masked = false;  // as in ldc_raster.comp
PARAMS(LdcParams)
BUFFER(readonly, 0, vec3, positions)
BUFFER(readonly, 1, uvec3, triangles)
BUFFER(, 2, LdcCounters, counters)
BUFFER(, 3, uint, node_masks)
BUFFER(writeonly, 4, LdcFragment, fragments)
BUFFER(readonly, 5, uvec2, blocks)
BUFFER(readonly, 6, LdcBody, bodies)
#define BASE_COLOR_FIRST_BINDING 7
#include "common/base_color_buffers.glsl"
#include "ldc/ldc_alpha.glsl"
#include "ldc/ldc_emit.glsl"
#include "ldc/ldc_projected.glsl"

void main() {
    if (GROUP_INDEX >= min(counters[0].blocks, params.block_capacity)) return;
    const uvec2 block = blocks[GROUP_INDEX];
    const uint id = block.x;
    const LdcPlace place = ldcPlaceOf(ldcBodyOfTriangle(id >> 2u));
    const CubeGrid grid = place.grid;
    const LdcTriangle t = ldcProjected(grid, id);
    const vec3 reach = ldcReach(t);
    ivec2 lo, hi;
    ldcBounds(t, uvec3(peelrayToLdi(vec3(grid.dims), id & 3u)).xy, lo, hi);
    const ivec2 corner = ivec2(block.y & 0xffffu, block.y >> 16u) * int(LDC_BLOCK);
    lo = max(lo, corner);
    hi = min(hi, corner + int(LDC_BLOCK) - 1);
    const uint width = uint(hi.x - lo.x + 1), pixels = width * uint(hi.y - lo.y + 1);
    uint count = 0u, covered = 0u;
    for (uint k = 0u; k < LDC_BLOCK * LDC_BLOCK / gl_WorkGroupSize.x; k++) {
        const uint j = k * gl_WorkGroupSize.x + gl_LocalInvocationIndex;
        if (j >= pixels) break;
        const ivec2 pixel = lo + ivec2(j % width, j / width);
        if (!ldcCovers(t, reach, vec2(pixel) + 0.5, params.sampling)) continue;
        if (masked && !ldcPresent(grid, id, vec2(pixel) + 0.5)) continue;
        covered |= 1u << k;
        count += ldcEmitPixel(t, pixel, id, place, false, 0u);
    }
    uint position = ldcReserve(count);
    for (uint k = 0u; covered >> k != 0u; k++) {
        if ((covered >> k & 1u) == 0u) continue;
        const uint j = k * gl_WorkGroupSize.x + gl_LocalInvocationIndex;
        position += ldcEmitPixel(t, lo + ivec2(j % width, j / width), id, place, true, position);
    }
}
