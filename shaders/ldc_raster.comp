// Rasterises small triangles, one thread each, into the LDIs that capture them; queues the large ones.
#version 460
#include "common.glsl"
#include "params.h"
layout(local_size_x = 64) in;
layout(constant_id = 0) const bool masked = false;  // centres where a material has a hole give no samples
PARAMS(LdcParams)
BUFFER(readonly, 0, vec3, positions)
BUFFER(readonly, 1, uvec3, triangles)
BUFFER(, 2, LdcCounters, counters)
BUFFER(, 3, uint, node_masks)
BUFFER(writeonly, 4, LdcFragment, fragments)
BUFFER(writeonly, 5, uint, big_triangles)
BUFFER(readonly, 6, LdcBody, bodies)
#define BASE_COLOR_FIRST_BINDING 7
#include "base_color_buffers.glsl"
#include "bounds.glsl"
#include "ldc_alpha.glsl"
#include "ldc_emit.glsl"

void main() {
    const uint id = params.first_triangle + GLOBAL_INDEX;
    bool valid = GLOBAL_INDEX < params.triangles && counters[0].cells <= params.cell_capacity;
    const LdcPlace place = ldcPlaceOf(valid ? ldcBodyOfTriangle(id) : params.first_body);
    const CubeGrid grid = place.grid;
    vec3 a = vec3(0), b = vec3(0), c = vec3(0), normal = vec3(0);
    if (valid) {
        const uvec3 corners = triangles[id];
        a = positions[corners.x];
        b = positions[corners.y];
        c = positions[corners.z];
        if (!(isBounded(a) && isBounded(b) && isBounded(c))) {
            atomicAdd(counters[0].invalid, 1u);
            valid = false;
        } else {
            normal = ldcNormal(a, b, c, grid.inv_voxel);
            if (normal == vec3(0)) {
                atomicAdd(counters[0].degenerate, 1u);
                valid = false;
            }
        }
    }
    for (uint axis = 0u; axis < 3u; axis++) {
        bool captured = valid && ldcCaptured(normal, axis, params.sampling);
        LdcTriangle t;
        ivec2 lo = ivec2(0), hi = ivec2(-1);
        if (captured) {
            t = ldcProject(grid, a, b, c, normal, axis);
            const uvec3 dims = uvec3(peelrayToLdi(vec3(grid.dims), axis));
            captured = ldcBounds(t, dims.xy, lo, hi);
            const ivec2 size = hi - lo + 1;
            if (captured && uint(size.x) * uint(size.y) > LDC_SMALL_PIXELS) {
                const uint slot = atomicAdd(counters[0].big, 1u);
                if (slot < params.big_capacity) big_triangles[slot] = id << 2u | axis;
                captured = false;
            }
        }
        const vec3 reach = captured ? ldcReach(t) : vec3(0);
        uint count = 0u;
        if (captured)
            for (int y = lo.y; y <= hi.y; y++)
                for (int x = lo.x; x <= hi.x; x++)
                    if (ldcCovers(t, reach, vec2(x, y) + 0.5, params.sampling) && (!masked || ldcPresent(grid, id << 2u | axis, vec2(x, y) + 0.5)))
                        count += ldcEmitPixel(t, ivec2(x, y), id << 2u | axis, place, false, 0u);
        uint position = ldcReserve(count);
        if (count != 0u)
            for (int y = lo.y; y <= hi.y; y++)
                for (int x = lo.x; x <= hi.x; x++)
                    if (ldcCovers(t, reach, vec2(x, y) + 0.5, params.sampling) && (!masked || ldcPresent(grid, id << 2u | axis, vec2(x, y) + 0.5)))
                        position += ldcEmitPixel(t, ivec2(x, y), id << 2u | axis, place, true, position);
    }
}
