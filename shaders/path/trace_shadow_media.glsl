// Traces the queue of shadow rays in the cubes where media may overlap or touch (path/media_walk.glsl).
#include "common/common.glsl"
#include "ldc/trace_params.h"
layout(local_size_x = 64) in;
#include "path/trace_shadow_options.glsl"
PARAMS(TraceParams)
#include "ldc/cube_fetch.glsl"
#define SCENE_FIRST_BINDING 14
#include "path/scene_buffers.glsl"
#include "path/media_params.h"
BUFFER(readonly, 30, MediaStack, shadow_media)
BUFFER(readonly, 32, uint, media_ranks)
#define HITS_TO_LIGHT
#define HITS_FORGET
#include "ldc/hit_hooks.glsl"
#include "peelray/peelray.glsl"
#include "ldc/cube_trace.glsl"
#include "path/frame.glsl"
#include "path/media.glsl"
#define MEDIA_FORGETS (hit_test == PEELRAY_EXACT)
#include "path/media_walk.glsl"
#define SHADOW_FIRST_BINDING 10
#define SHADOW_THROUGH_MEDIA
#include "path/trace_shadow.glsl"

PeelrayHit traceShadow(PeelrayRay ray, uvec2 skip, bool any) { return cubeTrace(ray, skip, shadowOptions(any)); }
PeelrayHit mediaNearest(PeelrayRay ray, uvec2 skip) { return traceShadow(ray, skip, false); }

vec2 mediaWeights(PeelrayRay ray, PeelrayHit hit) {
    return hit_test != PEELRAY_EXACT ? cubeWeights(hit.instance, hit.triangle, ray.origin + hit.t * ray.direction) : hit.uv;
}

void main() { shadowRay(GLOBAL_INDEX, params.count); }
