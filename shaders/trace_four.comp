// Traces a queue of rays in the cubes, four rays a thread (by pixel only).
#version 460
#include "common.glsl"
#include "params.h"
layout(local_size_x = 64) in;
layout(constant_id = 0) const bool any_hit = false;
layout(constant_id = 1) const uint hit_test = 0u;  // PEELRAY_EXACT, ...
layout(constant_id = 2) const bool precise_edges = false;
layout(constant_id = 3) const uint traversal = 0u;  // PEELRAY_VOXELS, ...
layout(constant_id = 4) const bool masked = false;  // the scene has masked materials
PARAMS(TraceParams)
#include "cube_fetch.glsl"
BUFFER(readonly, 10, Ray, rays)
BUFFER(readonly, 11, SurfaceId, skip)
BUFFER(readonly, 12, uint, queue)
BUFFER(writeonly, 13, Hit, hits)
#define BASE_COLOR_FIRST_BINDING 14
#include "base_color_buffers.glsl"
#include "alpha_test.glsl"
#define PEELRAY_PRECISE precise_edges
#define PEELRAY_ACCEPT(triangle, uv) (!masked || alphaPresent(triangle, uv))
#include "peelray/peelray.glsl"

void main() {
    const uint first = GLOBAL_INDEX * 4u;
    const uint count = params.counted != 0u ? min(params.count, queue[params.counter]) : params.count;
    if (first >= count) return;
    PeelrayRay own_rays[4];
    uvec2 own[4];
    for (int k = 0; k < 4; k++) {
        // A ray that there is none of becomes one that misses.
        const uint i = min(first + uint(k), count - 1u);
        const Ray ray = rays[i];
        own_rays[k] = PeelrayRay(ray.origin, ray.tmin, ray.direction, first + uint(k) < count ? ray.tmax : ray.tmin);
        own[k] = uvec2(PEELRAY_MISS);
        if (params.skips != 0u) own[k] = uvec2(skip[i].instance, skip[i].triangle);
    }
    const PeelrayOptions options = PeelrayOptions(any_hit, hit_test, traversal, params.tolerance, params.block, PEELRAY_ONE);
    PeelrayHit found[4];
    peelrayTraceFour(params.tree.instances, own_rays, own, options, found);
    for (int k = 0; k < 4; k++) {
        const uint i = first + uint(k);
        if (i >= count) return;
        vec2 uv = found[k].uv;
        if (hit_test != PEELRAY_EXACT && found[k].triangle != PEELRAY_MISS)
            uv = cubeWeights(found[k].instance, found[k].triangle, rays[i].origin + found[k].t * rays[i].direction);
        hits[i] = Hit(found[k].t, found[k].triangle, found[k].instance, uv.x, uv.y);
    }
}
