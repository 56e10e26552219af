// The two branches of a surface: what it reflects and what it lets through. Include after frame.glsl.
#ifndef PEELRAY_BRANCHES_GLSL
#define PEELRAY_BRANCHES_GLSL

#include "common/material.h"
#include "path/frame.h"
#include "path/path_params.h"

struct Branch {
    vec3 weight;      ///< 0: none
    vec3 direction;
    uint medium;      ///< of the new ray, with RAY_SEES_SUN
    bool traced;      ///< or looked up in a cube map
    float blur;       ///< roughness for the environment, if not traced
};
const Branch NO_BRANCH = Branch(vec3(0), vec3(0, 0, 1), MEDIUM_NONE, false, 0.0);

// Defined by the shader that includes this.
/// The half vector of a reflection.
vec3 microfacet(Surface s, vec3 view, float alpha, uint seed);
/// Part of the rough lobe that is traced; the rest sees the blurred environment.
float tracedPart(GpuMaterial m);
/// Sets `traced`.
void decide(inout Branch branch, vec3 path_weight, uint effect);

/// Both branches of a surface, and what it sends by itself.
vec3 scatterSurface(Surface s, vec3 incoming, RayState state, out Branch reflection, out Branch refraction) {
    reflection = refraction = NO_BRANCH;
    const GpuMaterial m = materials[s.material];
    if ((m.flags & MATERIAL_UNLIT) != 0u) return s.base_color;
    const vec3 view = -incoming;
    const bool thin = (m.flags & MATERIAL_THIN) != 0u;
    const bool transmits = m.transmission > 0.0 && m.metallic < 1.0;
    // Volumes are left where the ray meets their back; opaque and thin surfaces are the same from both sides.
    const bool leaving = transmits && !thin && !s.front;
    const float eta = thin || !transmits ? m.ior : (leaving ? 1.0 / m.ior : m.ior);
    const float alpha = m.roughness * m.roughness;
    const vec3 h = microfacet(s, view, alpha, state.seed);
    const float cosine = clamp(dot(view, h), 0.0, 1.0);
    float dielectric = fresnelDielectric(cosine, eta);
    if (transmits && thin) dielectric = 2.0 * dielectric / (1.0 + dielectric);  // both faces of the wall
    const vec3 metal = fresnelSchlick(s.base_color, cosine);
    const vec3 fresnel = mix(vec3(dielectric), metal, m.metallic);
    const bool mirror = m.roughness < MIRROR_ROUGHNESS;
    // After a rough surface the sun's disc is a light, not a thing to be seen: its image in a further mirror would be noise.
    const uint sun = mirror ? state.medium & RAY_SEES_SUN : 0u;
    const uint medium = state.medium & ~RAY_SEES_SUN;

    vec3 reflected = reflect(incoming, h);
    vec3 weight = fresnel;
    if (frame[0].spp > 1u && !mirror)
        weight *= dot(reflected, s.normal) > 0.0 ? ggxMasking(dot(reflected, s.normal), alpha) : 0.0;
    else if (!mirror && !transmits)
        weight = environmentBrdf(mix(vec3(pow((m.ior - 1.0) / (m.ior + 1.0), 2.0)), s.base_color, m.metallic), m.roughness, cosine);
    reflection = Branch(weight, aboveSurface(reflected, s.geometric), medium | sun, false, 0.0);
    decide(reflection, state.weight, EFFECT_REFLECTION);

    vec3 radiance = m.emissive;
    const float part = transmits ? 1.0 : tracedPart(m);
    if (part < 1.0) {  // the untraced part of a wide lobe, at once
        radiance += reflection.weight * (1.0 - part) * environmentRadiance(reflection.direction, m.roughness);
        reflection.weight *= part;
        reflection.traced = reflection.traced && part > 0.0;
    }
    reflection.blur = frame[0].spp > 1u ? 0.0 : m.roughness;

    if (transmits) {
        vec3 direction;
        bool passes = true;
        if (thin)
            direction = incoming;
        else
            passes = refractRay(incoming, h, eta, direction);
        if (passes) {
            const vec3 through = (1.0 - dielectric) * (1.0 - m.metallic) * m.transmission * s.base_color;
            const uint inside = thin ? medium : (leaving ? MEDIUM_NONE : s.material);
            refraction = Branch(through, direction, inside | sun, false, 0.0);
            decide(refraction, state.weight, EFFECT_REFRACTION);
        }
    }
    return radiance;
}

#endif
