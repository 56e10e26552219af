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
layout(constant_id = 5) const bool counting = false;
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
#define COUNT_FIRST_BINDING 25
#include "counting.glsl"
#define PEELRAY_ACCEPT(triangle, uv) (!masked || alphaPresent(triangle, uv))
#include "peelray/peelray.glsl"
#include "frame.glsl"
#include "lighting.glsl"

shared uint group_rays;
shared uint group_ambient;
uint shadow_rays = 0u, ambient_rays = 0u;  // of this thread

/// Layers of glass that a shadow ray passes before it counts as blocked.
const uint SHADOW_LAYERS = 16u;

/// Share of the light that arrives along the ray: 0 or 1, or the tint of the glass in between.
vec3 visibility(Ray leaving, SurfaceId from) {
    PeelrayRay ray = PeelrayRay(leaving.origin, leaving.tmin, leaving.direction, leaving.tmax);
    uvec2 skip = uvec2(from.instance, from.triangle);
    const PeelrayOptions options = PeelrayOptions(!glass, hit_test, traversal, frame[0].tolerance, frame[0].block, batch);
    if (!glass) return vec3(peelrayTrace(frame[0].tree, ray, skip, options).triangle == PEELRAY_MISS ? 1.0 : 0.0);
    vec3 share = vec3(1);
    for (uint layer = 0u; layer < SHADOW_LAYERS; layer++) {
        const PeelrayHit hit = peelrayTrace(frame[0].tree, ray, skip, options);
        if (hit.triangle == PEELRAY_MISS) return share;
        const GpuMaterial m = materials[triangle_materials[hit.triangle]];
        if (m.transmission == 0.0 || m.metallic == 1.0) return vec3(0);
        const vec2 uv = hit_test != PEELRAY_EXACT ? cubeWeights(hit.instance, hit.triangle, ray.origin + hit.t * ray.direction) : hit.uv;
        const Surface s = surfaceAt(hit.instance, hit.triangle, uv, ray.direction);
        const bool thin = (m.flags & MATERIAL_THIN) != 0u;
        float reflected = fresnelDielectric(clamp(-dot(ray.direction, s.normal), 0.0, 1.0), thin || s.front ? m.ior : 1.0 / m.ior);
        if (thin) reflected = 2.0 * reflected / (1.0 + reflected);  // both faces of the wall
        share *= (1.0 - reflected) * (1.0 - m.metallic) * m.transmission * s.base_color;
        // Light goes straight on: refraction would make it miss the lamp. Volumes absorb what crosses them.
        if (!thin && !s.front) share *= exp(-m.absorption * (layer == 0u ? hit.t : hit.t - ray.tmin));
        if (largest(share) < 1.0 / 512.0) return vec3(0);
        ray.tmin = hit.t;
        skip = uvec2(hit.instance, hit.triangle);
    }
    return vec3(0);
}

vec3 lightVisibility(uint index, Surface s, vec3 direction, SurfaceId from) {
    shadow_rays++;
    Ray ray = leavingRay(s, s.shadow_start, direction, uintBitsToFloat(0x7f800000u));
    if (lights[index].kind != 0u) ray.tmax = dot(lights[index].position - ray.origin, direction);
    countNothing();
    const vec3 share = visibility(ray, from);
    countRay(COUNT_SHADOW, 0u, GLOBAL_INDEX);
    return share;
}

vec3 skyVisibility(Surface s, uint seed, SurfaceId from) {
    // One cosine-distributed direction per sample: its mean is the sky that the surface really sees.
    const vec2 random = randomPair(seed, params.sample_index, RANDOM_SKY);
    vec3 t, b;
    tangents(s.normal, t, b);
    const float r = sqrt(random.x), phi = 2.0 * PI * random.y;
    const vec3 direction = aboveSurface(t * (r * cos(phi)) + b * (r * sin(phi)) + s.normal * sqrt(max(0.0, 1.0 - random.x)), s.geometric);
    ambient_rays++;
    countNothing();
    const vec3 share = visibility(leavingRay(s, s.shadow_start, direction, uintBitsToFloat(0x7f800000u)), from);
    countRay(COUNT_AMBIENT, 0u, GLOBAL_INDEX);
    return share;
}

void main() {
    const uint i = GLOBAL_INDEX;
    if (gl_LocalInvocationIndex == 0u) group_rays = group_ambient = 0u;
    barrier();
    if (i < min(params.capacity, queue[params.level])) {
        const Hit hit = hits[i];
        if (hit.triangle != NO_TRIANGLE) {
            const vec3 direction = rays[i].direction;
            const Surface s = surfaceAt(hit.instance, hit.triangle, vec2(hit.u, hit.v), direction);
            const vec3 light = lightSurface(s, SurfaceId(hit.instance, hit.triangle), -direction, states[i].seed);
            nodes[i].radiance += light * transmittance(states[i].medium, hit.t);
        }
    }
    if (shadow_rays > 0u) atomicAdd(group_rays, shadow_rays);
    if (ambient_rays > 0u) atomicAdd(group_ambient, ambient_rays);
    barrier();
    if (gl_LocalInvocationIndex == 0u) {
        if (group_rays > 0u) atomicAdd(queue[QUEUE_SHADOW], group_rays);
        if (group_ambient > 0u) atomicAdd(queue[QUEUE_AMBIENT], group_ambient);
    }
}
