// What a hit reflects, lets through and emits by itself: starts the next level's rays and the tree's node. Misses see the
// environment.
#version 460
#include "common.glsl"
#include "params.h"
layout(local_size_x = 64) in;
PARAMS(LevelParams)
#define SCENE_FIRST_BINDING 0
#define SCENE_WITH_TRIANGLES
#include "scene_buffers.glsl"
BUFFER(readonly, 12, Ray, rays)
BUFFER(readonly, 13, RayState, states)
BUFFER(readonly, 14, Hit, hits)
BUFFER(writeonly, 15, PathNode, nodes)
BUFFER(, 16, uint, queue)
BUFFER(writeonly, 17, Ray, next_rays)
BUFFER(writeonly, 18, RayState, next_states)
BUFFER(writeonly, 19, SurfaceId, next_skip)
#include "frame.glsl"
#include "branches.glsl"

/// Branches that carry less than this share of the pixel are not traced: they see the environment.
const float LEAST_WEIGHT = 1.0 / 512.0;

shared uint group_counts[2];   // reflection, refraction rays of the workgroup
shared uint group_first;

/// The half vector: the normal itself for mirrors and with one sample per pixel, else a sample of the visible normals.
vec3 microfacet(Surface s, vec3 view, float alpha, uint seed) {
    if (frame[0].spp <= 1u || alpha < MIRROR_ROUGHNESS * MIRROR_ROUGHNESS) return s.normal;
    vec3 t, b;
    tangents(s.normal, t, b);
    const vec3 local = vec3(dot(view, t), dot(view, b), max(1e-4, dot(view, s.normal)));
    const vec2 random = randomPair(seed, params.sample_index, RANDOM_MICROFACET);
    const vec3 h = sampleGgx(normalize(local), alpha, random);
    return normalize(t * h.x + b * h.y + s.normal * h.z);
}

/// Part of the rough lobe that is traced; the rest sees the blurred environment. One sample cannot follow a wide lobe.
float tracedPart(GpuMaterial m) {
    if (frame[0].spp > 1u) return m.roughness < 0.6 || m.metallic > 0.5 ? 1.0 : 0.0;
    return 1.0 - smoothstep(0.2, 0.5, m.roughness);
}

void decide(inout Branch branch, vec3 path_weight, uint effect) {
    branch.traced = (frame[0].effects & effect) != 0u && params.level < frame[0].last_level &&
                    largest(branch.weight * path_weight) >= LEAST_WEIGHT;
}

void emitRay(uint index, Branch branch, Surface s, SurfaceId from, vec3 path_weight, uint seed) {
    if (index >= params.next_capacity) return;
    const float infinity = uintBitsToFloat(0x7f800000u);
    next_rays[index] = leavingRay(s, s.position, branch.direction, infinity);
    next_states[index] = RayState(path_weight * branch.weight, branch.medium, seed);
    next_skip[index] = from;
}

void main() {
    const uint i = GLOBAL_INDEX, lane = gl_LocalInvocationIndex;
    if (lane < 2u) group_counts[lane] = 0u;
    barrier();
    const bool valid = i < min(params.capacity, queue[params.level]);
    PathNode node = PathNode(vec3(0), NO_CHILD, vec3(0), NO_CHILD, vec3(0));
    Branch reflection = NO_BRANCH, refraction = NO_BRANCH;
    Surface s;
    SurfaceId from = SurfaceId(0u, NO_TRIANGLE);
    uint slot0 = 0u, slot1 = 0u, seed = 0u;
    vec3 path_weight = vec3(0);
    if (valid) {
        const Ray ray = rays[i];
        RayState state = states[i];
        seed = state.seed;
        const Hit hit = hits[i];
        from = SurfaceId(hit.instance, hit.triangle);
        if (hit.triangle == NO_TRIANGLE) {
            node.radiance = skyRadiance(ray.direction, (state.medium & RAY_SEES_SUN) != 0u);
        } else {
            s = surfaceAt(hit.instance, hit.triangle, vec2(hit.u, hit.v), ray.direction);
            const vec3 lost = transmittance(state.medium, hit.t);
            state.weight *= lost;
            path_weight = state.weight;
            node.radiance = scatterSurface(s, ray.direction, state, reflection, refraction);
            // What is not traced sees the environment.
            if (!reflection.traced) node.radiance += reflection.weight * environmentRadiance(reflection.direction, reflection.blur);
            if (!refraction.traced) node.radiance += refraction.weight * environmentRadiance(refraction.direction, 0.0);
            node.radiance *= lost;
            node.weight0 = reflection.weight * lost;
            node.weight1 = refraction.weight * lost;
        }
        if (reflection.traced) slot0 = atomicAdd(group_counts[0], 1u);
        if (refraction.traced) slot1 = atomicAdd(group_counts[1], 1u);
    }
    barrier();
    if (lane == 0u && group_counts[0] + group_counts[1] > 0u) {
        group_first = atomicAdd(queue[params.level + 1u], group_counts[0] + group_counts[1]);
        if (group_counts[0] > 0u) atomicAdd(queue[QUEUE_REFLECTION], group_counts[0]);
        if (group_counts[1] > 0u) atomicAdd(queue[QUEUE_REFRACTION], group_counts[1]);
        if (group_first + group_counts[0] + group_counts[1] > params.next_capacity) queue[QUEUE_OVERFLOW] = 1u;
    }
    barrier();
    if (!valid) return;
    if (reflection.traced) {
        node.child0 = group_first + slot0;
        emitRay(node.child0, reflection, s, from, path_weight, hash3(uvec3(seed, 0u, params.level)).x);
    }
    if (refraction.traced) {
        node.child1 = group_first + group_counts[0] + slot1;
        emitRay(node.child1, refraction, s, from, path_weight, hash3(uvec3(seed, 1u, params.level)).x);
    }
    nodes[i] = node;
}
