// What path/media_walk.glsl needs of the device's own ray tracing. Hits do not remember which triangles a ray has
// passed: of three walls at the very same distance two are found.
#include "khr/khr_trace.glsl"
#define SCENE_FIRST_BINDING KHR_SCENE_FIRST_BINDING
#define SCENE_WITH_TRIANGLES
#include "path/scene_buffers.glsl"
#include "path/frame.glsl"
#include "path/media_params.h"
#include "peelray/ray.glsl"
#define MEDIA_FORGETS false

PeelrayHit mediaNearest(PeelrayRay ray, uvec2 skip) {
    const Hit hit = khrTrace(Ray(ray.origin, ray.tmin, ray.direction, ray.tmax), SurfaceId(skip.x, skip.y), gl_RayFlagsNoneEXT);
    return PeelrayHit(hit.t, hit.triangle, hit.instance, vec2(hit.u, hit.v));
}

void mediaForget(uint instance, uint triangle) {}

vec2 mediaWeights(PeelrayRay ray, PeelrayHit hit) { return hit.uv; }
