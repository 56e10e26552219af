// Light from the lamps, the sun and the diffuse sky at the hits of a level, by shadow rays, whoever traces them.
#ifndef PEELRAY_SHADOW_GLSL
#define PEELRAY_SHADOW_GLSL

#include "frame.glsl"
#include "lighting.glsl"

// Defined by the shader that includes this, beside the buffers and whether the scene has `glass`:
/// What a shadow ray meets: anything, or with `glass` the first. Not the triangle that it leaves.
Hit traceShadow(Ray ray, SurfaceId from);
/// Weights of the hit triangle's second and third corner.
vec2 shadowWeights(Ray ray, Hit hit);

uint shadow_rays = 0u, ambient_rays = 0u;  // of this thread

/// Layers of glass that a shadow ray passes before it counts as blocked.
const uint SHADOW_LAYERS = 16u;

/// Share of the light that arrives along the ray: 0 or 1, or the tint of the glass in between.
vec3 visibility(Ray ray, SurfaceId from) {
    if (!glass) return vec3(traceShadow(ray, from).triangle == NO_TRIANGLE ? 1.0 : 0.0);
    vec3 share = vec3(1);
    for (uint layer = 0u; layer < SHADOW_LAYERS; layer++) {
        const Hit hit = traceShadow(ray, from);
        if (hit.triangle == NO_TRIANGLE) return share;
        const GpuMaterial m = materials[triangle_materials[hit.triangle]];
        if (m.transmission == 0.0 || m.metallic == 1.0) return vec3(0);
        const Surface s = surfaceAt(hit.instance, hit.triangle, shadowWeights(ray, hit), ray.direction);
        const bool thin = (m.flags & MATERIAL_THIN) != 0u;
        float reflected = fresnelDielectric(clamp(-dot(ray.direction, s.normal), 0.0, 1.0), thin || s.front ? m.ior : 1.0 / m.ior);
        if (thin) reflected = 2.0 * reflected / (1.0 + reflected);  // both faces of the wall
        share *= (1.0 - reflected) * (1.0 - m.metallic) * m.transmission * s.base_color;
        // Light goes straight on: refraction would make it miss the lamp. Volumes absorb what crosses them.
        if (!thin && !s.front) share *= exp(-m.absorption * (layer == 0u ? hit.t : hit.t - ray.tmin));
        if (largest(share) < 1.0 / 512.0) return vec3(0);
        ray.tmin = hit.t;
        from = SurfaceId(hit.instance, hit.triangle);
    }
    return vec3(0);
}

vec3 lightVisibility(uint index, Surface s, vec3 direction, SurfaceId from) {
    shadow_rays++;
    Ray ray = leavingRay(s, s.shadow_start, direction, uintBitsToFloat(0x7f800000u));
    if (lights[index].kind != 0u) ray.tmax = dot(lights[index].position - ray.origin, direction);
    return visibility(ray, from);
}

vec3 skyVisibility(Surface s, uint seed, SurfaceId from) {
    // One cosine-distributed direction per sample: its mean is the sky that the surface really sees.
    const vec2 random = randomPair(seed, params.sample_index, RANDOM_SKY);
    vec3 t, b;
    tangents(s.normal, t, b);
    const float r = sqrt(random.x), phi = 2.0 * PI * random.y;
    const vec3 direction = aboveSurface(t * (r * cos(phi)) + b * (r * sin(phi)) + s.normal * sqrt(max(0.0, 1.0 - random.x)), s.geometric);
    ambient_rays++;
    return visibility(leavingRay(s, s.shadow_start, direction, uintBitsToFloat(0x7f800000u)), from);
}

/// Adds to the node of hit i of the level what lamps, sun and sky give it.
void lightHit(uint i) {
    const Hit hit = hits[i];
    if (hit.triangle == NO_TRIANGLE) return;
    const vec3 direction = rays[i].direction;
    const Surface s = surfaceAt(hit.instance, hit.triangle, vec2(hit.u, hit.v), direction);
    const vec3 light = lightSurface(s, SurfaceId(hit.instance, hit.triangle), -direction, states[i].seed);
    nodes[i].radiance += light * transmittance(states[i].medium, hit.t);
}

#endif
