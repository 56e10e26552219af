// Traces a queue of rays in the cubes where media may overlap or touch: as far as the next surface that is a surface to
// the ray (path/media_walk.glsl). Apart, since what it needs of surfaces would slow down the tracing of other scenes.
#include "common/common.glsl"
#include "common/ray.h"
#include "ldc/trace_params.h"
#include "path/media_params.h"
layout(local_size_x = 64) in;
#include "path/trace_shadow_options.glsl"
layout(constant_id = 9) const bool camera = false;  // what the rays hit first is in `hits`
PARAMS(TraceParams)
#include "ldc/cube_fetch.glsl"
BUFFER_ALIGNED(readonly, 10, Ray, rays)
BUFFER(readonly, 11, SurfaceId, skip)
BUFFER(, 12, uint, queue)
BUFFER(, 13, Hit, hits)
#define SCENE_FIRST_BINDING 14
#include "path/scene_buffers.glsl"
#include "path/media_trace_buffers.glsl"
#define HITS_FORGET
#include "ldc/hit_hooks.glsl"
#include "peelray/peelray.glsl"
#include "ldc/cube_trace.glsl"
#include "path/frame.glsl"
#include "path/media.glsl"
#define MEDIA_FORGETS (hit_test == PEELRAY_EXACT)
#include "path/media_walk.glsl"

PeelrayHit mediaNearest(PeelrayRay ray, uvec2 skip) { return cubeTrace(ray, skip, shadowOptions(false)); }

vec2 mediaWeights(PeelrayRay ray, PeelrayHit hit) {
    return hit_test != PEELRAY_EXACT ? cubeWeights(hit.instance, hit.triangle, ray.origin + hit.t * ray.direction) : hit.uv;
}

#include "path/media_trace.glsl"

void main() {
    const uint i = GLOBAL_INDEX;
    if (i >= (params.counted != 0u ? min(params.count, queue[params.counter]) : params.count)) return;
    countNothing();
    mediaTrace(i, camera, camera ? uvec2(PEELRAY_MISS) : uvec2(skip[i].instance, skip[i].triangle));
    countRay(COUNT_TRACED, 0u, i);
}
