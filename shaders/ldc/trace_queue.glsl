// What the passes that trace a queue of rays in the cubes share.
#include "common/ray.h"
#include "ldc/trace_params.h"
layout(local_size_x = 64) in;
layout(constant_id = 0) const bool any_hit = false;
layout(constant_id = 1) const uint hit_test = 0u;  // PEELRAY_EXACT, ...
layout(constant_id = 2) const bool precise_edges = false;
layout(constant_id = 3) const uint traversal = 0u;  // PEELRAY_VOXELS, ...
layout(constant_id = 4) const bool masked = false;  // the scene has masked materials
layout(constant_id = 5) const bool counting = false;
layout(constant_id = 10) const bool single_sided = false;  // the scene has single-sided materials
layout(constant_id = 18) const bool refined = false;   // some voxels are
layout(constant_id = 8) const bool deferred = false;  // triangles are tested after their list's samples
PARAMS(TraceParams)
#include "ldc/cube_fetch.glsl"
BUFFER_ALIGNED(readonly, 10, Ray, rays)
BUFFER(readonly, 11, SurfaceId, skip)
BUFFER(readonly, 12, uint, queue)
BUFFER(writeonly, 13, Hit, hits)
#define BASE_COLOR_FIRST_BINDING 14
#include "common/base_color_buffers.glsl"
#include "ldc/hit_hooks.glsl"
#define COUNT_FIRST_BINDING 20
#include "common/counting.glsl"
#define PEELRAY_PRECISE precise_edges
#define PEELRAY_DEFER deferred
#include "peelray/peelray.glsl"

/// Rays in the queue.
uint queueLength() { return params.counted != 0u ? min(params.count, queue[params.counter]) : params.count; }

/// The surface that ray i of the queue leaves, which it cannot hit.
uvec2 queueSkip(uint i) { return params.skips != 0u ? uvec2(skip[i].instance, skip[i].triangle) : uvec2(PEELRAY_MISS); }

/// Stores what ray i of the queue hit.
void queueStore(uint i, Ray ray, PeelrayHit hit) {
    vec2 uv = hit.uv;
    if (hit_test != PEELRAY_EXACT && hit.triangle != PEELRAY_MISS) uv = cubeWeights(hit.instance, hit.triangle, ray.origin + hit.t * ray.direction);
    hits[i] = Hit(hit.t, hit.triangle, hit.instance, uv.x, uv.y);
}
