// The grid of every body of a build, from its bounds, and where its parts of the tables begin. One workgroup.
#version 460
#include "common/common.glsl"
#include "ldc/ldc_params.h"
#include "common/bounds.glsl"
#include "ldc/ldc_grid.h"
layout(local_size_x = 64) in;
PARAMS(LdcParams)
BUFFER(readonly, 0, uvec3, body_lower)
BUFFER(readonly, 1, uvec3, body_upper)
BUFFER(, 2, LdcBody, bodies)
BUFFER(, 3, LdcCounters, counters)
BUFFER(writeonly, 4, LdcExtent, extent)

shared uvec4 partial[64];

void main() {
    const uint lane = gl_LocalInvocationIndex;
    uvec4 carry = uvec4(0);  // lines along x, y, z; cells or pixels
    for (uint base = 0u; base < params.bodies; base += 64u) {
        const uint body = params.first_body + base + lane;
        const bool valid = base + lane < params.bodies;
        uvec4 own = uvec4(0);
        if (valid) {
            const CubeGrid grid = ldcMakeGrid(orderedFloats(body_lower[body]), orderedFloats(body_upper[body]), bodies[body].resolution & ~LDC_BARE);
            const uvec3 tops = grid.dims >> 4u;
            own = uvec4(tops.y * tops.z, tops.z * tops.x, tops.x * tops.y, tops.x * tops.y * tops.z);
            if (params.by_pixel != 0u) own.w = 256u * (own.x + own.y + own.z);
            if ((bodies[body].resolution & LDC_BARE) != 0u) own = uvec4(0);
            bodies[body].grid = grid;
            if (params.by_pixel == 0u && params.sampling == LDC_CENTRE && bodies[body].tolerance * grid.inv_voxel > LDC_FARTHEST_BY_VOXEL)
                atomicOr(counters[0].wrapped, LDC_FAR_TOLERANCE);
        }
        partial[lane] = own;
        barrier();
        for (uint step = 1u; step < 64u; step <<= 1u) {
            const uvec4 other = lane >= step ? partial[lane - step] : uvec4(0);
            barrier();
            partial[lane] += other;
            barrier();
        }
        if (valid) {
            const uvec4 before = carry + partial[lane] - own;
            bodies[body].first_line = before.xyz;
            bodies[body].first_cell = params.first_cell + before.w;
        }
        if (lane == 0u && carry.w + partial[63].w < carry.w) atomicOr(counters[0].wrapped, LDC_WRAPPED_CELLS);
        carry += partial[63];
        barrier();
    }
    if (lane == 0u) {
        // One more offset ends the last pixel's list; whole tiles of tiles, so that what follows lies as this does.
        counters[0].cells = carry.w + (params.by_pixel != 0u ? 256u : 0u);
        extent[0] = LdcExtent(carry.xyz, carry.w);
    }
}
