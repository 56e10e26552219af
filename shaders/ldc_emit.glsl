// Emitting the fragments of a workgroup: each thread counts its own first, one atomic reserves room for all.
#ifndef PEELRAY_LDC_EMIT_GLSL
#define PEELRAY_LDC_EMIT_GLSL

#include "ldc_common.glsl"

shared uint emit_sums[gl_WorkGroupSize.x];
shared uint emit_base;

/// Where this thread's `count` fragments go; all threads of the workgroup must call.
uint ldcReserve(uint count) {
    const uint lane = gl_LocalInvocationIndex;
    emit_sums[lane] = count;
    barrier();
    for (uint step = 1u; step < gl_WorkGroupSize.x; step <<= 1u) {
        const uint other = lane >= step ? emit_sums[lane - step] : 0u;
        barrier();
        emit_sums[lane] += other;
        barrier();
    }
    if (lane == gl_WorkGroupSize.x - 1u && emit_sums[lane] != 0u) {
        emit_base = atomicAdd(counters[0].fragments, emit_sums[lane]);
        if (emit_base + emit_sums[lane] < emit_base) counters[0].wrapped = 1u;
    }
    barrier();
    const uint position = emit_base + emit_sums[lane] - count;
    barrier();
    return position;
}

/// Fragments of the triangle in the pixel: counted if `write` is false, else written from `position` on. Returns how many.
/// `first_top`: the build's first 16x16x16 cell of the body, whose grid has `dims` voxels.
uint ldcEmitPixel(LdcTriangle t, ivec2 pixel, uint id, uvec3 dims, uint first_top, bool write, uint position) {
    const bool planar = params.planar != 0u;
    const uint axis = id & 3u;
    const uint depth = dims[axis];
    ivec2 range = ldcDepthRange(t, vec2(pixel) + 0.5, planar);
    range = clamp(range, ivec2(0), ivec2(int(depth) - 1));
    if (write)
        for (int w = range.x; w <= range.y; w++) {
            const uint index = position + uint(w - range.x);
            const uvec3 voxel = ldcFromLdi(uvec3(pixel, w), axis);
            const uint top = first_top + ldcTopIndex(voxel, dims), node = ldcNodeInTop(voxel);
            const uint word = top * 2u + (node >> 5u), bit = 1u << (node & 31u);
            // Most bits are set already: looking first is cheaper than an atomic.
            if ((node_masks[word] & bit) == 0u) atomicOr(node_masks[word], bit);
            if (index < params.fragment_capacity) fragments[index] = LdcFragment(top, id, node << 6u | ldcVoxelInNode(voxel));
        }
    return uint(range.y - range.x + 1);
}

#endif
