// Appends what a pass of depth peeling left in its targets: one thread per pixel of the three LDIs.
#version 460
#include "common/common.glsl"
#include "ldc/ldc_params.h"
layout(local_size_x = 64) in;
PARAMS(LdcParams)
BUFFER(readonly, 0, vec3, positions)
BUFFER(readonly, 1, uvec3, triangles)
BUFFER(, 2, LdcCounters, counters)
BUFFER(readonly, 3, LdcBody, bodies)
BUFFER(, 4, uint, node_masks)
BUFFER(writeonly, 5, LdcFragment, fragments)
IMAGE(6, texture2DArray, depth_map)
IMAGE(7, utexture2DArray, id_map)
#include "ldc/ldc_emit.glsl"
#include "ldc/ldc_projected.glsl"
#include "ldc/ldc_peel.glsl"

void main() {
    const uint row = GLOBAL_INDEX / params.side, axis = row / params.side;
    const ivec2 pixel = ivec2(GLOBAL_INDEX % params.side, row % params.side);
    const LdcPlace place = ldcPlaceOf(params.first_body);
    const CubeGrid grid = place.grid;
    uint id = LDC_NOTHING, count = 0u;
    if (axis < 3u) id = texelFetch(id_map, ivec3(pixel, axis), 0).y;
    LdcTriangle t;
    if (id != LDC_NOTHING && params.by_pixel == 0u) t = ldcProjected(grid, id);
    if (id != LDC_NOTHING) count = params.by_pixel == 0u ? ldcEmitPixel(t, pixel, id, place, false, 0u) : 1u;
    const uint position = ldcReserve(count);
    if (id == LDC_NOTHING) return;
    if (params.by_pixel == 0u)
        ldcEmitPixel(t, pixel, id, place, true, position);
    else
        ldcWriteDepth(position, pixel, id, place, peelDepth(texelFetch(depth_map, ivec3(pixel, axis), 0).w, float(grid.dims[axis])));
}
