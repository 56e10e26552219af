// Traces a queue of rays in the cubes, four rays per thread (by pixel only).
#version 460
#include "common/common.glsl"
#include "common/ray.h"
#include "ldc/trace_params.h"
#define COUNT_RAYS 4
#define PEELRAY_ONLY_PIXELS
#include "ldc/trace_queue.glsl"

void main() {
    const uint first = GLOBAL_INDEX * 4u;
    const uint count = queueLength();
    if (first >= count) return;
    PeelrayRay own_rays[4];
    uvec2 own[4];
    for (int k = 0; k < 4; k++) {
        // A ray that does not exist becomes one that misses.
        const uint i = min(first + uint(k), count - 1u);
        const Ray ray = rays[i];
        own_rays[k] = PeelrayRay(ray.origin, ray.tmin, ray.direction, first + uint(k) < count ? ray.tmax : ray.tmin);
        own[k] = queueSkip(i);
    }
    const PeelrayOptions options = PeelrayOptions(any_hit, hit_test, traversal, params.tolerance, params.block, PEELRAY_ONE, 0u, 0u, false);
    PeelrayHit found[4];
    countNothing();
    peelrayTraceFour(params.tree.instances, own_rays, own, options, found);
    for (int k = 0; k < 4; k++) {
        const uint i = first + uint(k);
        if (i >= count) return;
        queueStore(i, rays[i], found[k]);
        countRay(COUNT_TRACED, uint(k), i);
    }
}
