// What rasterising triangles takes, however threads share the pixels of small ones: reading them, and cutting large ones into blocks of
// pixels. RASTER_THREADS: of a workgroup, which reads LDC_TRIANGLES.
#include "common/common.glsl"
#include "ldc/ldc_params.h"
layout(local_size_x = RASTER_THREADS) in;
layout(constant_id = 0) const bool masked = false;       // centres where a material has a hole give no samples
layout(constant_id = 1) const uint small_pixels = 48u;  // most of a small triangle's bounds: no more than 128
layout(constant_id = 2) const bool keeps_corners = false;  // for `exact` hits
PARAMS(LdcParams)
BUFFER(readonly, 0, vec3, positions)
BUFFER(readonly, 1, uvec3, triangles)
BUFFER(, 2, LdcCounters, counters)
BUFFER(, 3, uint, node_masks)
BUFFER(writeonly, 4, LdcFragment, fragments)
BUFFER(writeonly, 5, uvec2, blocks)
BUFFER(readonly, 6, LdcBody, bodies)
BUFFER_ALIGNED(writeonly, 16, LdcCorners, corners)
#define BASE_COLOR_FIRST_BINDING 7
#include "common/base_color_buffers.glsl"
#include "common/bounds.glsl"
#include "ldc/ldc_alpha.glsl"
#include "ldc/ldc_corners.glsl"
#include "ldc/ldc_emit.glsl"
#include "ldc/ldc_projected.glsl"

const uint LDC_TRIANGLES = 64u;
// Triangles that touch many blocks are cut by all threads of the workgroup.
const uint LDC_MANY_BLOCKS = 16u;
shared uint group_valid;  // has the workgroup anything to rasterise?
shared uint many_count;
shared uint many[3u * LDC_TRIANGLES];  // of a triangle in up to three LDIs

/// Queues the blocks of pixels that a large triangle touches: of those in its bounds number `first`, `first` + `step`, ...
void queueBlocks(LdcTriangle t, ivec2 lo, ivec2 hi, uint id, uint first, uint step) {
    const uvec2 corner = uvec2(lo) / LDC_BLOCK, size = uvec2(hi) / LDC_BLOCK - corner + 1u;
    const vec3 reach = ldcReach(t);
    // Half a block and a pixel: never tighter than the test of the pixels themselves.
    const float half_block = float(LDC_BLOCK) * 0.5;
    for (uint i = first; i < size.x * size.y; i += step) {
        const uvec2 block = corner + uvec2(i % size.x, i / size.x);
        if (any(lessThan(ldcEdges(t, vec2(block) * float(LDC_BLOCK) + half_block), -(half_block + 0.51) * reach))) continue;
        const uint slot = atomicAdd(counters[0].blocks, 1u);
        if (slot < params.block_capacity) blocks[slot] = uvec2(id, block.x | block.y << 16u);
    }
}

bool touchesMany(ivec2 lo, ivec2 hi) {
    const uvec2 size = uvec2(hi) / LDC_BLOCK - uvec2(lo) / LDC_BLOCK + 1u;
    return size.x * size.y > LDC_MANY_BLOCKS;
}

/// Is this a triangle that is not degenerate and whose bounds contain no pixel's centre in any LDI? Most of a fine mesh
/// are: they need not be projected.
bool missesCentres(CubeGrid grid, vec3 a, vec3 b, vec3 c) {
    const vec3 lower = (min(a, min(b, c)) - grid.origin) * grid.inv_voxel - (0.5 + 2.0 * LDC_SLACK);
    const vec3 upper = (max(a, max(b, c)) - grid.origin) * grid.inv_voxel - (0.5 - 2.0 * LDC_SLACK);
    const bvec3 holds = greaterThanEqual(floor(upper), ceil(lower));
    if ((holds.x && holds.y) || (holds.y && holds.z) || (holds.z && holds.x)) return false;
    const vec3 e = b - a, f = c - a, normal = abs(cross(e, f)), sizes = abs(e), other = abs(f);
    return max(normal.x, max(normal.y, normal.z)) >
           1e-5 * max(sizes.x, max(sizes.y, sizes.z)) * max(other.x, max(other.y, other.z));
}

/// A triangle as its thread reads it.
struct RasterTriangle {
    uint id, body;
    vec3 a, b, c, normal;
};

/// False: there is nothing to rasterise.
bool readTriangle(CubeGrid grid, inout RasterTriangle triangle) {
    const uvec3 indices = triangles[triangle.id];
    triangle.a = positions[indices.x];
    triangle.b = positions[indices.y];
    triangle.c = positions[indices.z];
    if (!(isBounded(triangle.a) && isBounded(triangle.b) && isBounded(triangle.c))) {
        atomicAdd(counters[0].invalid, 1u);
        return false;
    }
    if (params.sampling != LDC_CONSERVATIVE && missesCentres(grid, triangle.a, triangle.b, triangle.c)) return false;
    triangle.normal = ldcNormal(triangle.a, triangle.b, triangle.c, grid.inv_voxel);
    if (keeps_corners) corners[triangle.id] = ldcPackCorners(grid, triangle.a, triangle.b, triangle.c, triangle.normal);
    if (triangle.normal == vec3(0)) {
        atomicAdd(counters[0].degenerate, 1u);
        return false;
    }
    return true;
}

/// By all threads of the workgroup.
void cutMany() {
    for (uint i = 0u; i < many_count; i++) {
        const uint large = many[i];
        const CubeGrid grid = bodies[ldcBodyOfTriangle(large >> 2u)].grid;
        const LdcTriangle t = ldcProjected(grid, large);
        ivec2 lo, hi;
        ldcBounds(t, uvec3(peelrayToLdi(vec3(grid.dims), large & 3u)).xy, lo, hi);
        queueBlocks(t, lo, hi, large, gl_LocalInvocationIndex, gl_WorkGroupSize.x);
    }
}

/// What a triangle is to the workgroup: its pixels are gone through (true: `lo` to `hi`), its blocks queued, or left to all threads.
bool isSmall(LdcTriangle t, uint id, CubeGrid grid, out ivec2 lo, out ivec2 hi) {
    if (!ldcBounds(t, uvec3(peelrayToLdi(vec3(grid.dims), id & 3u)).xy, lo, hi)) return false;
    const uvec2 size = uvec2(hi - lo + 1);
    if (size.x * size.y <= small_pixels) return true;
    if (touchesMany(lo, hi))
        many[atomicAdd(many_count, 1u)] = id;
    else
        queueBlocks(t, lo, hi, id, 0u, 1u);
    return false;
}

/// The triangle of each of the workgroup's first threads; false: there is none to rasterise. All threads must call. `any`: the workgroup
/// has one.
bool readTriangles(out RasterTriangle triangle, out bool any) {
    const uint index = GROUP_INDEX * LDC_TRIANGLES + gl_LocalInvocationIndex;
    triangle.id = params.first_triangle + index;
    triangle.a = triangle.b = triangle.c = triangle.normal = vec3(0);
    bool valid = gl_LocalInvocationIndex < LDC_TRIANGLES && index < params.triangles && LDC_CELLS_FIT(counters[0]);
    triangle.body = valid ? ldcBodyOfTriangle(triangle.id) : params.first_body;
    if (valid) valid = readTriangle(bodies[triangle.body].grid, triangle);
    if ((bodies[triangle.body].resolution & LDC_BARE) != 0u) valid = false;
    if (gl_LocalInvocationIndex == 0u) many_count = group_valid = 0u;
    barrier();
    if (valid) group_valid = 1u;
    barrier();
    any = group_valid != 0u;
    return valid;
}
