// Light from the lamps, the sun and the diffuse sky at each hit of a level: one shadow ray per light that the surface faces.
#version 460
#include "common.glsl"
#include "params.h"
layout(local_size_x = 64) in;
layout(constant_id = 0) const bool planar = false;
layout(constant_id = 1) const bool glass = false;  // the scene has surfaces that let light through
PARAMS(LevelParams)
#include "cube_fetch.glsl"
#define SCENE_FIRST_BINDING 7
#include "scene_buffers.glsl"
BUFFER(readonly, 16, Ray, rays)
BUFFER(readonly, 17, RayState, states)
BUFFER(readonly, 18, Hit, hits)
BUFFER(, 19, PathNode, nodes)
BUFFER(, 20, uint, queue)
BUFFER(readonly, 21, GpuLight, lights)
#include "peelray/peelray.glsl"
#include "frame.glsl"

shared uint group_rays;
shared uint group_ambient;

/// Layers of glass that a shadow ray passes before it counts as blocked.
const uint SHADOW_LAYERS = 16u;

/// Share of the light that arrives along the ray: 0 or 1, or the tint of the glass in between.
vec3 visibility(vec3 start, vec3 direction, float distance, uint triangle) {
    PeelrayRay ray = PeelrayRay(start, 0.0, direction, distance);
    if (!glass) return vec3(peelrayTrace(frame[0].grid, ray, triangle, true, planar).triangle == PEELRAY_MISS ? 1.0 : 0.0);
    vec3 share = vec3(1);
    uint skip = triangle;
    for (uint layer = 0u; layer < SHADOW_LAYERS; layer++) {
        const PeelrayHit hit = peelrayTrace(frame[0].grid, ray, skip, false, planar);
        if (hit.triangle == PEELRAY_MISS) return share;
        const GpuMaterial m = materials[triangle_materials[hit.triangle]];
        if (m.transmission == 0.0 || m.metallic == 1.0) return vec3(0);
        const vec2 uv = planar ? cubeWeights(hit.triangle, start + hit.t * direction) : hit.uv;
        const Surface s = surfaceAt(hit.triangle, uv, direction);
        const bool thin = (m.flags & MATERIAL_THIN) != 0u;
        float reflected = fresnelDielectric(clamp(-dot(direction, s.normal), 0.0, 1.0), thin || s.front ? m.ior : 1.0 / m.ior);
        if (thin) reflected = 2.0 * reflected / (1.0 + reflected);  // both faces of the wall
        share *= (1.0 - reflected) * (1.0 - m.metallic) * m.transmission * s.base_color;
        // Light goes straight on: refraction would make it miss the lamp. Volumes absorb what crosses them.
        if (!thin && !s.front) share *= exp(-m.absorption * (layer == 0u ? hit.t : hit.t - ray.tmin));
        if (largest(share) < 1.0 / 512.0) return vec3(0);
        ray.tmin = hit.t;
        skip = hit.triangle;
    }
    return vec3(0);
}

/// Irradiance of a light on a surface that faces it, without visibility; `direction`: to the light.
vec3 lightAt(GpuLight light, vec3 position, out vec3 direction, out float distance) {
    distance = uintBitsToFloat(0x7f800000u);
    direction = -light.direction;
    if (light.kind == 0u) return light.color;
    const vec3 to_light = light.position - position;
    const float distance2 = dot(to_light, to_light);
    distance = sqrt(distance2);
    if (distance == 0.0) return vec3(0);
    direction = to_light / distance;
    // KHR_lights_punctual: inverse square with a smooth end at the range.
    const float r = distance / light.range, r2 = r * r;
    float strength = clamp(1.0 - r2 * r2, 0.0, 1.0) / distance2;
    if (light.kind == 2u) {
        const float cone = clamp(dot(light.direction, -direction) * light.cone_scale + light.cone_offset, 0.0, 1.0);
        strength *= cone * cone;
    }
    return light.color * strength;
}

/// Reflected share of light from `to_light`, times the cosine.
vec3 reflectance(Surface s, GpuMaterial m, vec3 view, vec3 to_light) {
    const float n_l = dot(s.normal, to_light);
    if (n_l <= 0.0) return vec3(0);
    const vec3 h = normalize(view + to_light);
    const float n_v = max(1e-4, dot(s.normal, view)), n_h = clamp(dot(s.normal, h), 0.0, 1.0), v_h = clamp(dot(view, h), 0.0, 1.0);
    const vec3 f0 = mix(vec3(pow((m.ior - 1.0) / (m.ior + 1.0), 2.0)), s.base_color, m.metallic);
    const vec3 fresnel = fresnelSchlick(f0, v_h);
    vec3 result = (1.0 - m.metallic) * (1.0 - m.transmission) * (1.0 - fresnel) * s.base_color / PI;
    if (m.roughness >= MIRROR_ROUGHNESS) {
        const float alpha = m.roughness * m.roughness;
        result += fresnel * ggxDistribution(n_h, alpha) * ggxMasking(n_v, alpha) * ggxMasking(n_l, alpha) / (4.0 * n_v * n_l);
    }
    return result * n_l;
}

vec3 lightSurface(Surface s, uint triangle, vec3 view, uint seed, inout uint shadow_rays, inout uint ambient_rays) {
    const GpuMaterial m = materials[s.material];
    if ((m.flags & MATERIAL_UNLIT) != 0u) return vec3(0);
    const bool shadows = (frame[0].effects & EFFECT_SHADOW) != 0u;
    vec3 sum = vec3(0);
    for (uint i = 0u; i < frame[0].lights; i++) {
        vec3 direction;
        float distance;
        const vec3 light = lightAt(lights[i], s.position, direction, distance);
        if (dot(s.geometric, direction) <= 0.0 || light == vec3(0)) continue;
        const vec3 reflected = light * reflectance(s, m, view, direction);
        if (reflected == vec3(0)) continue;
        if (!shadows) {
            sum += reflected;
            continue;
        }
        shadow_rays++;
        const vec3 start = offsetStart(s, s.shadow_start, direction);
        const float reach = lights[i].kind == 0u ? distance : dot(lights[i].position - start, direction);
        sum += reflected * visibility(start, direction, reach, triangle);
    }
    vec3 diffuse = (1.0 - m.metallic) * (1.0 - m.transmission) * s.base_color / PI;
    if (diffuse == vec3(0)) return sum;
    // What the surface mirrors does not reach its body: the share that scatter.comp gives to the reflection.
    const float cosine = clamp(dot(view, s.normal), 0.0, 1.0);
    diffuse *= 1.0 - (m.roughness < MIRROR_ROUGHNESS ? vec3(fresnelDielectric(cosine, m.ior))
                                                     : environmentBrdf(vec3(pow((m.ior - 1.0) / (m.ior + 1.0), 2.0)), m.roughness, cosine));
    vec3 ambient = environmentIrradiance(s.normal);
    if ((frame[0].effects & EFFECT_AMBIENT) != 0u) {
        // One cosine-distributed direction per sample: its mean is the sky that the surface really sees.
        const vec2 random = randomPair(seed, params.sample_index, RANDOM_SKY);
        vec3 t, b;
        tangents(s.normal, t, b);
        const float r = sqrt(random.x), phi = 2.0 * PI * random.y;
        const vec3 direction = aboveSurface(t * (r * cos(phi)) + b * (r * sin(phi)) + s.normal * sqrt(max(0.0, 1.0 - random.x)), s.geometric);
        ambient_rays++;
        ambient *= visibility(offsetStart(s, s.shadow_start, direction), direction, uintBitsToFloat(0x7f800000u), triangle);
    }
    return sum + diffuse * ambient;
}

void main() {
    const uint i = GLOBAL_INDEX;
    if (gl_LocalInvocationIndex == 0u) group_rays = group_ambient = 0u;
    barrier();
    uint shadow_rays = 0u, ambient_rays = 0u;
    if (i < min(params.capacity, queue[params.level])) {
        const Hit hit = hits[i];
        if (hit.triangle != 0xffffffffu) {
            const vec3 direction = rays[i].direction;
            const Surface s = surfaceAt(hit.triangle, vec2(hit.u, hit.v), direction);
            const vec3 light = lightSurface(s, hit.triangle, -direction, states[i].seed, shadow_rays, ambient_rays);
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
