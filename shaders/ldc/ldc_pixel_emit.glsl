// The fragments of a triangle in a pixel, for either order: what every rasteriser ends in. Include after the buffers bodies,
// node_masks and fragments.
#ifndef PEELRAY_LDC_PIXEL_EMIT_GLSL
#define PEELRAY_LDC_PIXEL_EMIT_GLSL

#include "ldc/ldc_params.h"

#include "ldc/ldc_bodies.glsl"
#include "ldc/ldc_common.glsl"

/// What rasterising needs to know of a body.
struct LdcPlace {
    CubeGrid grid;
    uint first_cell;  ///< the body's first 16x16x16 cell or pixel, counted from the build's first
    float tolerance;  ///< voxels
};

LdcPlace ldcPlaceOf(uint body) {
    const CubeGrid grid = bodies[body].grid;
    return LdcPlace(grid, ldcFirstCell(body), bodies[body].tolerance * grid.inv_voxel);
}

/// Writes the by-pixel fragment of a triangle whose depth is known already.
void ldcWriteDepth(uint position, ivec2 pixel, uint id, LdcPlace place, float w) {
    if (position < params.fragment_capacity)
        fragments[position] = LdcFragment(place.first_cell + ldcPixelOfBody(uvec2(pixel), id & 3u, place.grid.dims), id, floatBitsToUint(w));
}

/// Fragments of the triangle in the pixel: counted if `write` is false, else written from `position` on. Returns how many.
uint ldcEmitPixel(LdcTriangle t, ivec2 pixel, uint id, LdcPlace place, bool write, uint position) {
    const uint axis = id & 3u;
    const uvec3 dims = place.grid.dims;
    if (params.by_pixel != 0u) {
        if (write) {
            float w = ldcDepth(t, vec2(pixel) + 0.5);
            if (params.by_pixel == 2u) w = ldcRoundDepth(w, float(dims[axis]));
            ldcWriteDepth(position, pixel, id, place, w);
        }
        return 1u;
    }
    ivec2 range = ldcDepthRange(t, vec2(pixel) + 0.5, params.sampling, place.tolerance);
    range = clamp(range, ivec2(0), ivec2(int(dims[axis]) - 1));
    uint count = 0u;
    for (int w = range.x; w <= range.y; w++) {
        if (params.sampling == LDC_CONSERVATIVE && !ldcTouches(t, vec3(pixel, w) + 0.5)) continue;
        const uint index = position + count;
        count++;
        if (write) {
            const uvec3 voxel = ldcFromLdi(uvec3(pixel, w), axis);
            const uint cell = place.first_cell + ldcTopIndex(voxel, dims), node = ldcNodeInTop(voxel);
            const uint word = cell * 2u + (node >> 5u), bit = 1u << (node & 31u);
            // Most bits are set already: looking first is cheaper than an atomic.
            if ((node_masks[word] & bit) == 0u) atomicOr(node_masks[word], bit);
            if (index < params.fragment_capacity) fragments[index] = LdcFragment(cell, id, node << 6u | ldcVoxelInNode(voxel));
        }
    }
    return count;
}

#endif
