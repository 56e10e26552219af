// The grid of a cube, from the box of its body: one text for C++ and GLSL, so that both see the same cube.
#ifndef PEELRAY_LDC_GRID_H
#define PEELRAY_LDC_GRID_H

#include "peelray/cube.h"

#ifdef __cplusplus
namespace peelray {
#define LDC_FUNCTION inline
#else
#define LDC_FUNCTION
#endif

/// The largest of three.
LDC_FUNCTION float ldcLargest(float a, float b, float c) {
#ifdef __cplusplus
    using glm::max;
#endif
    return max(a, max(b, c));
}

/// Voxels along one side of a cube of `voxels` (not whole), at most `n`, which is a multiple of 16.
LDC_FUNCTION uint ldcSide(float voxels, uint n) {
#ifdef __cplusplus
    using glm::clamp;
    using std::ceil;
#endif
    return clamp(uint(ceil(voxels / 16.0f)) * 16u, 16u, n);
}

/// Start of a side of `voxels` voxels around [lower, upper].
LDC_FUNCTION float ldcStart(float lower, float upper, uint voxels, float voxel) {
    return lower - 0.5f * (float(voxels) * voxel - (upper - lower));
}

/// The grid of `n` voxels (a multiple of 16) along the longest side of the box [lower, upper] grown by a voxel on each
/// side; each side is rounded up to a multiple of 16 voxels. An empty box (lower > upper) has a grid too.
LDC_FUNCTION CubeGrid ldcMakeGrid(vec3 lower, vec3 upper, uint n) {
#ifdef __cplusplus
    using glm::max;
    const auto abs = [](float x) { return x < 0 ? -x : x; };
#endif
    CubeGrid grid;
    if (!(lower.x <= upper.x && lower.y <= upper.y && lower.z <= upper.z)) lower = upper = vec3(0.0f);
    const vec3 size = upper - lower;
    // A body thinner than the rounding of its own coordinates still needs voxels of some size: the grid's start must be
    // off by less than a voxel.
    const float reach =
        max(ldcLargest(abs(lower.x), abs(lower.y), abs(lower.z)), ldcLargest(abs(upper.x), abs(upper.y), abs(upper.z)));
    const float longest = max(ldcLargest(size.x, size.y, size.z), 1e-30f);
    grid.voxel = max(longest / float(n - 2u), reach * 2.4e-7f);
    grid.inv_voxel = 1.0f / grid.voxel;
    // The margin of a voxel on each side, less what rounding may add to a side that is a whole number already.
    const float margin = 2.0f - 1e-3f;
    grid.dims = uvec3(ldcSide(size.x / grid.voxel + margin, n), ldcSide(size.y / grid.voxel + margin, n),
                      ldcSide(size.z / grid.voxel + margin, n));
    grid.origin =
        vec3(ldcStart(lower.x, upper.x, grid.dims.x, grid.voxel), ldcStart(lower.y, upper.y, grid.dims.y, grid.voxel),
             ldcStart(lower.z, upper.z, grid.dims.z, grid.voxel));
    return grid;
}

#ifdef __cplusplus
}  // namespace peelray
#endif
#endif
