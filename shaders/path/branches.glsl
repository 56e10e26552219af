// The two branches of a surface: what it reflects and what it lets through. Include after frame.glsl and the buffer split_sum.
#ifndef PEELRAY_BRANCHES_GLSL
#define PEELRAY_BRANCHES_GLSL

#include "path/cone.glsl"
#include "path/frame.h"
#include "path/interface.glsl"
#include "path/path_params.h"
#include "path/split_sum.glsl"

struct Branch {
    vec3 weight;      ///< 0: none
    vec3 direction;
    uint medium;      ///< of the new ray, with RAY_SEES_SUN
    bool traced;      ///< or looked up in a cube map
    float blur;       ///< roughness for the environment, if not traced
    uint cone;        ///< of the new ray
    uint effect;      ///< EFFECT_*: a clear coat's is a reflection in the refraction's place
};
const Branch NO_BRANCH = Branch(vec3(0), vec3(0, 0, 1), MEDIUM_NONE, false, 0.0, 0u, 0u);

/// Is a surface's second branch what its clear coat mirrors?
bool isCoat(Branch second) { return coated && second.effect == EFFECT_REFLECTION; }

/// A new ray's cone, where anything is filtered by it.
uint keptCone(vec2 cone) { return filtered ? packCone(cone) : 0u; }

// Defined by the shader that includes this.
/// Does microfacet() sample rough surfaces? Else it is the normal, and one direction stands for all of the lobe.
bool samplesMicrofacets();
/// The half vector of a reflection around `normal`; `purpose`: RANDOM_*.
vec3 microfacet(vec3 normal, vec3 view, float alpha, uint seed, uint purpose);
/// Part of the rough lobe that is traced; the rest sees the blurred environment.
float tracedPart(float roughness, float metallic);
/// Sets `traced` by the branch's effect; `passes`: the ray goes on through a blended surface.
void decide(inout Branch branch, RayState state, bool passes);

/// What of a surface's light is left where it covers a part only; what lets pass the rest is its second branch. Thin glass sends its
/// light the same way.
void passBeside(Surface s, vec3 incoming, RayState state, vec2 cone, inout vec3 radiance, inout Branch reflection, inout Branch refraction) {
    if (!blended || s.alpha >= 1.0) return;
    radiance *= s.alpha;
    reflection.weight *= s.alpha;
    const uint passed = (state.medium & RAY_PASSES) == RAY_PASSES ? state.medium : state.medium + RAY_PASSED;
    refraction = Branch(refraction.weight * s.alpha + (1.0 - s.alpha), incoming, passed, false, 0.0, keptCone(cone), EFFECT_REFRACTION);
    decide(refraction, state, true);
}

/// What the untraced part of a wide lobe sees, at once; the branch keeps the rest.
vec3 fade(inout Branch branch, float roughness, float metallic) {
    const float part = tracedPart(roughness, metallic);
    if (part >= 1.0) return vec3(0);
    const vec3 seen = branch.weight * (1.0 - part) * environmentRadiance(branch.direction, roughness);
    branch.weight *= part;
    branch.traced = branch.traced && part > 0.0;
    return seen;
}

/// A clear coat on a surface takes its share of the light and lets the rest through, both ways at once (KHR_materials_clearcoat). What it
/// mirrors is the second branch of an opaque surface; glass and blended surfaces, which need that one, mirror it with their own, if they have
/// one.
void addCoat(Surface s, Material m, vec3 incoming, RayState state, vec2 cone, bool has_second, inout vec3 radiance, inout Branch reflection,
             inout Branch refraction) {
    const vec3 view = -incoming;
    const float share = coatShare(m, dot(view, s.coat_normal)), alpha = m.coat_roughness * m.coat_roughness;
    const bool mirror = m.coat_roughness < MIRROR_ROUGHNESS;
    radiance *= 1.0 - share;
    reflection.weight *= 1.0 - share;
    refraction.weight *= 1.0 - share;
    if (has_second && largest(reflection.weight) > 0.0) {
        reflection.weight += share;
        decide(reflection, state, false);
        return;
    }
    const vec3 h = microfacet(s.coat_normal, view, alpha, state.seed, RANDOM_COAT), reflected = reflect(incoming, h);
    float weight = share;
    if (samplesMicrofacets() && !mirror) {
        const float above = dot(reflected, s.coat_normal);
        weight = m.clearcoat * fresnelSchlick(vec3(COAT_REFLECTANCE), 1.0, clamp(dot(view, h), 0.0, 1.0)).x * (above > 0.0 ? ggxMasking(above, alpha) : 0.0);
    }
    Branch coat = Branch(vec3(weight), aboveSurface(reflected, s.geometric), state.medium & ~(mirror ? 0u : RAY_SEES_SUN), false, 0.0,
                        keptCone(coneReflected(cone, s.curvature)), EFFECT_REFLECTION);
    decide(coat, state, false);
    radiance += fade(coat, m.coat_roughness, 0.0);
    coat.blur = samplesMicrofacets() ? 0.0 : m.coat_roughness;
    if (has_second)
        reflection = coat;
    else
        refraction = coat;
}

/// Both branches of a surface, and what it sends by itself; `cone`: of the incoming ray at the hit.
vec3 scatterSurface(Surface s, vec3 incoming, Interface face, RayState state, vec2 cone, out Branch reflection, out Branch refraction) {
    reflection = refraction = NO_BRANCH;
    const Material m = materialOf(s);
    vec3 radiance = m.emissive;
    if ((m.flags & MATERIAL_UNLIT) != 0u) {
        radiance = s.base_color;
        passBeside(s, incoming, state, cone, radiance, reflection, refraction);
        return radiance;
    }
    const vec3 view = -incoming;
    const bool thin = (m.flags & MATERIAL_THIN) != 0u;
    const bool transparent = transmits(m);
    const float alpha = m.roughness * m.roughness;
    const vec3 h = microfacet(s.normal, view, alpha, state.seed, RANDOM_MICROFACET);
    const float cosine = clamp(dot(view, h), 0.0, 1.0);
    const bool mirror = m.roughness < MIRROR_ROUGHNESS, averaged = !samplesMicrofacets() && !mirror;
    vec3 dielectric = vec3(0);
    if (!averaged || transparent) dielectric = interfaceReflectance(m, face, cosine);
    // After a rough surface the sun's disc is a light, not a thing to be seen: its image in a further mirror would be noise.
    const uint sun = mirror ? state.medium & RAY_SEES_SUN : 0u;
    const uint medium = state.medium & ~RAY_SEES_SUN;

    vec3 reflected = reflect(incoming, h);
    vec3 weight;
    if (averaged && !transparent) {
        const vec4 means = splitSum(m.roughness, cosine);
        weight = mix(dielectricAlbedo(m, means), metalAlbedo(s.base_color, means), m.metallic);
    } else {
        weight = mix(dielectric, fresnelSchlick(s.base_color, 1.0, cosine), m.metallic);
        // Seen from inside, no table tells the mean reflectance: then the masking's mean has to do.
        if (averaged)
            weight *= splitSum(m.roughness, cosine).x;
        else if (!mirror)
            weight *= dot(reflected, s.normal) > 0.0 ? ggxMasking(dot(reflected, s.normal), alpha) : 0.0;
    }
    reflection = Branch(weight, aboveSurface(reflected, s.geometric), medium | sun, false, 0.0,
                        keptCone(coneReflected(cone, s.curvature)), EFFECT_REFLECTION);
    decide(reflection, state, false);
    if (!transparent) radiance += fade(reflection, m.roughness, m.metallic);
    reflection.blur = samplesMicrofacets() ? 0.0 : m.roughness;

    if (transparent) {
        vec3 direction;
        bool passes = true;
        if (thin)
            direction = incoming;
        else
            passes = refractRay(incoming, h, face.eta, direction);
        if (passes) {
            const vec3 through = (1.0 - dielectric) * transmissionTint(m, s.base_color);
            const uint inside = thin ? medium : (s.front ? s.material : MEDIUM_NONE) | (state.medium & RAY_PASSES);
            const vec2 beyond = thin ? cone : coneRefracted(cone, s.curvature, face.eta);
            refraction = Branch(through, direction, inside | sun, false, 0.0, keptCone(beyond), EFFECT_REFRACTION);
            decide(refraction, state, false);
        }
    }
    if (coated && m.clearcoat > 0.0) addCoat(s, m, incoming, state, cone, transparent || s.alpha < 1.0, radiance, reflection, refraction);
    passBeside(s, incoming, state, cone, radiance, reflection, refraction);
    return radiance;
}

#endif
