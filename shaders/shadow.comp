// Light from the lamps, the sun and the diffuse sky at each hit of a level: one shadow ray per light that the surface faces.
#version 460
#include "common.glsl"
#include "params.h"
layout(local_size_x = 64) in;
layout(constant_id = 0) const uint hit_test = 0u;  // PEELRAY_EXACT, ...
layout(constant_id = 1) const bool glass = false;  // the scene has surfaces that let light through
layout(constant_id = 2) const uint traversal = 0u;  // PEELRAY_VOXELS, ...
layout(constant_id = 3) const uint batch = 0u;      // PEELRAY_ONE, ...
layout(constant_id = 4) const bool masked = false;  // it has masked materials
PARAMS(LevelParams)
#include "cube_fetch.glsl"
#define SCENE_FIRST_BINDING 10
#include "scene_buffers.glsl"
BUFFER(readonly, 19, Ray, rays)
BUFFER(readonly, 20, RayState, states)
BUFFER(readonly, 21, Hit, hits)
BUFFER(, 22, PathNode, nodes)
BUFFER(, 23, uint, queue)
BUFFER(readonly, 24, GpuLight, lights)
#include "alpha_test.glsl"
#define PEELRAY_ACCEPT(triangle, uv) (!masked || alphaPresent(triangle, uv))
#include "peelray/peelray.glsl"
#include "shadow.glsl"

shared uint group_rays;
shared uint group_ambient;

Hit traceShadow(Ray ray, SurfaceId from) {
    const PeelrayOptions options = PeelrayOptions(!glass, hit_test, traversal, frame[0].tolerance, frame[0].block, batch);
    const PeelrayHit hit =
        peelrayTrace(frame[0].tree, PeelrayRay(ray.origin, ray.tmin, ray.direction, ray.tmax), uvec2(from.instance, from.triangle), options);
    return Hit(hit.t, hit.triangle, hit.instance, hit.uv.x, hit.uv.y);
}

vec2 shadowWeights(Ray ray, Hit hit) {
    return hit_test != PEELRAY_EXACT ? cubeWeights(hit.instance, hit.triangle, ray.origin + hit.t * ray.direction) : vec2(hit.u, hit.v);
}

void main() {
    const uint i = GLOBAL_INDEX;
    if (gl_LocalInvocationIndex == 0u) group_rays = group_ambient = 0u;
    barrier();
    if (i < min(params.capacity, queue[params.level])) lightHit(i);
    if (shadow_rays > 0u) atomicAdd(group_rays, shadow_rays);
    if (ambient_rays > 0u) atomicAdd(group_ambient, ambient_rays);
    barrier();
    if (gl_LocalInvocationIndex == 0u) {
        if (group_rays > 0u) atomicAdd(queue[QUEUE_SHADOW], group_rays);
        if (group_ambient > 0u) atomicAdd(queue[QUEUE_AMBIENT], group_ambient);
    }
}
