// Traces the queue of shadow rays in the cubes.
#include "common/common.glsl"
#include "ldc/trace_params.h"
layout(local_size_x = 64) in;
#include "path/trace_shadow_options.glsl"
PARAMS(TraceParams)
#include "ldc/cube_fetch.glsl"
#define BASE_COLOR_FIRST_BINDING 14
#include "common/base_color_buffers.glsl"
#define HITS_TO_LIGHT
#include "ldc/hit_hooks.glsl"
#include "peelray/peelray.glsl"
#include "ldc/cube_trace.glsl"
#define SHADOW_FIRST_BINDING 10
#include "path/trace_shadow.glsl"

PeelrayHit traceShadow(PeelrayRay ray, uvec2 skip, bool any) { return cubeTrace(ray, skip, shadowOptions(any)); }

void main() { shadowRay(GLOBAL_INDEX, params.count); }
