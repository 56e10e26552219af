// Traces the queue of shadow rays in the cubes, through surfaces that let light pass: apart, since what it needs of the materials
// would slow down the tracing of scenes without any.
#include "common/common.glsl"
#include "ldc/trace_params.h"
layout(local_size_x = 64) in;
#include "path/trace_shadow_options.glsl"
PARAMS(TraceParams)
#include "ldc/cube_fetch.glsl"
#define SCENE_FIRST_BINDING 14
#include "path/scene_buffers.glsl"
#define HITS_TO_LIGHT
#include "ldc/hit_hooks.glsl"
#include "peelray/peelray.glsl"
#include "ldc/cube_trace.glsl"
#include "path/frame.glsl"
#define SHADOW_FIRST_BINDING 10
#define SHADOW_THROUGH_GLASS
#include "path/trace_shadow.glsl"

PeelrayHit traceShadow(PeelrayRay ray, uvec2 skip, bool any) { return cubeTrace(ray, skip, shadowOptions(any)); }

vec2 shadowWeights(PeelrayRay ray, PeelrayHit hit) {
    return hit_test != PEELRAY_EXACT ? cubeWeights(hit.instance, hit.triangle, ray.origin + hit.t * ray.direction) : hit.uv;
}

void main() { shadowRay(GLOBAL_INDEX, params.count); }
