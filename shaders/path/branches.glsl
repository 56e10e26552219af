// The two branches of a surface: what it reflects and what it lets through. Include after frame.glsl.
#ifndef PEELRAY_BRANCHES_GLSL
#define PEELRAY_BRANCHES_GLSL

#include "path/cone.glsl"
#include "path/frame.h"
#include "path/interface.glsl"
#include "path/lobe.glsl"
#include "path/path_params.h"
#include "path/tables.glsl"

struct Branch {
    vec3 weight;      ///< 0: none
    vec3 direction;
    uint medium;      ///< of the new ray, with RAY_SEES_SUN
    bool traced;      ///< or looked up in a cube map
    float blur;       ///< roughness for the environment, if not traced
    uint cone;        ///< of the new ray
    uint effect;      ///< EFFECT_*: a clear coat's is a reflection in the refraction's place
    bool dispersed;   ///< `direction` is green's alone
    vec3 red, blue;   ///< theirs
    float density;    ///< of the new ray (RayState)
};
const Branch NO_BRANCH = Branch(vec3(0), vec3(0, 0, 1), MEDIUM_NONE, false, 0.0, 0u, 0u, false, vec3(0, 0, 1), vec3(0, 0, 1), 0.0);
Branch branchAlong(vec3 weight, vec3 direction, uint medium, uint cone, uint effect, float density) {
    return Branch(weight, direction, medium, false, 0.0, cone, effect, false, direction, direction, density);
}

/// The RAY_CHANNEL of a ray, as a number from 0.
uint channelOf(uint medium) { return dispersive ? (medium & RAY_CHANNEL) / RAY_CHANNEL_UNIT : 0u; }

/// Is a surface's second branch what its clear coat mirrors?
bool isCoat(Branch second) { return coated && second.effect == EFFECT_REFLECTION; }

/// A new ray's cone, where anything is filtered by it.
uint keptCone(vec2 cone) { return filtered ? packCone(cone) : 0u; }

// Defined by the shader that includes this.
/// Does microfacet() sample rough surfaces? Else it is the normal, and one direction stands for all of the lobe.
bool samplesMicrofacets();
/// Does it sample this lobe?
bool isSampled(Lobe lobe) { return samplesMicrofacets() && !isMirror(lobe); }
/// The half vector of a lobe's reflection; `purpose`: RANDOM_*.
vec3 microfacet(Lobe lobe, vec3 view, uint seed, uint purpose);
/// Part of the rough lobe that is traced; the rest sees the blurred environment.
float tracedPart(float roughness, float metallic);
/// Sets `traced` by the branch's effect; `passes`: the ray goes on through a blended surface.
void decide(inout Branch branch, RayState state, bool passes);

/// Do cones hold how much rough lobes blur? Such rays see filtered levels.
bool blursCones();
/// Of the environment's light what a ray of this density, cone and RayState::medium brings; the rest is found otherwise. `blur` in
/// [0, 1]: roughness.
vec3 environmentSeen(vec3 direction, float blur, float density, uint cone, uint medium);

/// The cone of what a lobe sends on; `part`: of its alpha.
vec2 lobeCone(vec2 cone, Lobe lobe, float part) {
    return blursCones() && !isMirror(lobe) ? coneBlurred(cone, part * lobe.roughness * lobe.roughness) : cone;
}

/// What a branch that is not traced sees.
vec3 untracedLight(Branch branch) {
    vec3 light = environmentSeen(branch.direction, branch.blur, branch.density, branch.cone, branch.medium);
    if (dispersive && branch.dispersed) {
        light.r = environmentSeen(branch.red, branch.blur, branch.density, branch.cone, branch.medium).r;
        light.b = environmentSeen(branch.blue, branch.blur, branch.density, branch.cone, branch.medium).b;
    }
    return branch.weight * light;
}

/// What of a surface's light is left where it covers a part only; what lets pass the rest is its second branch. Thin glass sends its
/// light the same way.
void passBeside(Surface s, vec3 incoming, RayState state, vec2 cone, inout vec3 radiance, inout Branch reflection, inout Branch refraction) {
    if (!blended || s.alpha >= 1.0) return;
    radiance *= s.alpha;
    reflection.weight *= s.alpha;
    const uint passed = (state.medium & RAY_PASSES) == RAY_PASSES ? state.medium : state.medium + RAY_PASSED;
    refraction = branchAlong(refraction.weight * s.alpha + (1.0 - s.alpha), incoming, passed, keptCone(cone), EFFECT_REFRACTION, state.density);
    decide(refraction, state, true);
}

/// What the untraced part of a wide lobe sees, at once; the branch keeps the rest.
vec3 fade(inout Branch branch, float roughness, float metallic) {
    const float part = tracedPart(roughness, metallic);
    if (part >= 1.0) return vec3(0);
    const vec3 seen = branch.weight * (1.0 - part) * environmentRadiance(branch.direction, roughness);
    branch.weight *= part;
    branch.traced = branch.traced && part > 1e-6;  // smoothstep() may miss its end by rounding
    return seen;
}

/// A clear coat on a surface takes its share of the light and lets the rest through, both ways at once (KHR_materials_clearcoat). What it
/// mirrors is the second branch of an opaque surface; glass and blended surfaces, which need that one, mirror it with their own, if they have
/// one.
void addCoat(Surface s, Material m, vec3 incoming, RayState state, vec2 cone, bool has_second, inout vec3 radiance, inout Branch reflection,
             inout Branch refraction) {
    const vec3 view = -incoming;
    const float share = coatShare(m, dot(view, s.coat_normal));
    radiance *= 1.0 - share;
    reflection.weight *= 1.0 - share;
    refraction.weight *= 1.0 - share;
    if (has_second && largest(reflection.weight) > 0.0) {
        reflection.weight += share;
        decide(reflection, state, false);
        return;
    }
    const Lobe lobe = roundLobe(s.coat_normal, m.coat_roughness);
    const vec3 h = microfacet(lobe, view, state.seed, RANDOM_COAT), reflected = reflect(incoming, h);
    float weight = share;
    if (isSampled(lobe))
        weight = m.clearcoat * fresnelSchlick(vec3(COAT_REFLECTANCE), 1.0, clamp(dot(view, h), 0.0, 1.0)).x * masking(lobe, reflected);
    const vec3 direction = aboveSurface(reflected, s.geometric);
    const float density = isSampled(lobe) && !has_second ? lobeDensity(lobe, view, normalize(view + direction)) : 0.0;
    Branch coat = branchAlong(vec3(weight), direction, state.medium & ~(isMirror(lobe) ? 0u : RAY_SEES_SUN),
                              keptCone(lobeCone(coneReflected(cone, s.curvature), lobe, 1.0)), EFFECT_REFLECTION, density);
    decide(coat, state, false);
    radiance += fade(coat, m.coat_roughness, 0.0);
    coat.blur = samplesMicrofacets() ? 0.0 : m.coat_roughness;
    if (has_second)
        reflection = coat;
    else
        refraction = coat;
}

/// May a coat be mirrored by the branch of what is below it? Then light of the environment is found by that branch alone.
bool sharesBranch(Surface s, Material m) { return coated && m.clearcoat > 0.0 && (transmits(m) || s.alpha < 1.0); }

/// What a microfacet makes of a ray.
struct Facet {
    vec3 normal;
    vec3 dielectric;  ///< reflectance of what is no metal
    vec3 reflected;
    vec3 through;     ///< of red, green and blue the middle one
    bool passes;      ///< or all is reflected
};

/// `incoming` as the microfacet of a thin wall lets it through: as often to this side of the straight way as the other face lets it.
vec3 throughThin(Lobe lobe, vec3 incoming, vec3 reflected) {
    return isSampled(lobe) ? reflect(reflected, lobe.normal) : incoming;
}

Facet facetOf(Surface s, Material m, Lobe lobe, vec3 incoming, Interface face, uint seed) {
    Facet f;
    f.normal = microfacet(lobe, -incoming, seed, RANDOM_MICROFACET);
    f.reflected = reflect(incoming, f.normal);
    f.dielectric = vec3(0);
    f.through = incoming;
    f.passes = transmits(m);
    // The mean over an opaque lobe comes from a table.
    if (samplesMicrofacets() || isMirror(lobe) || f.passes) f.dielectric = interfaceReflectance(m, face, clamp(-dot(incoming, f.normal), 0.0, 1.0));
    if (!f.passes) return f;
    if ((m.flags & MATERIAL_THIN) != 0u) {
        f.through = throughThin(lobe, incoming, f.reflected);
        return f;
    }
    f.passes = refractRay(incoming, f.normal, face.eta, f.through);
    if (!dispersive || f.passes || !face.disperses) return f;
    // One of the others passes all the same; of the middle one nothing does.
    f.passes = any(lessThan(f.dielectric, vec3(1)));
    f.through = lobe.normal;
    return f;
}

/// What the two ways of a rough microfacet of glass keep of the light: masking takes some of both. All of it with EFFECT_COMPENSATION: what
/// one way loses goes both (for opaque surfaces Turquin's factor is the mean of this).
void keptByGlass(Facet f, Lobe lobe, out vec3 reflected, out vec3 through) {
    reflected = f.dielectric * masking(lobe, f.reflected);
    through = 1.0 - f.dielectric;
    if ((frame[0].effects & EFFECT_COMPENSATION) == 0u) return;
    through *= f.passes ? masking(lobe, -f.through) : 0.0;
    const vec3 kept = reflected + through;
    reflected = mix(reflected / max(kept, vec3(1e-30)), f.dielectric, equal(kept, vec3(0)));
    through = mix(through / max(kept, vec3(1e-30)), 1.0 - f.dielectric, equal(kept, vec3(0)));
}

/// Shares of the light that a facet, or all of the lobe that it stands for, reflects and lets through.
void sharesOf(Facet f, Material m, Interface face, vec3 base_color, Lobe lobe, vec3 view, out vec3 reflected, out vec3 through) {
    const float cosine = clamp(dot(view, f.normal), 0.0, 1.0), facing = clamp(dot(view, lobe.normal), 0.0, 1.0);
    const bool compensated = (frame[0].effects & EFFECT_COMPENSATION) != 0u;
    reflected = f.dielectric;
    through = 1.0 - f.dielectric;
    if (isMirror(lobe)) {
        reflected = mix(reflected, metalReflectance(m, face, base_color, cosine), m.metallic);
        return;
    }
    const vec4 means = splitSum(lobe.mean_roughness, facing);
    const Gains gains = gainsOf(m, base_color, means);
    if (samplesMicrofacets()) {
        const float kept = masking(lobe, f.reflected);
        const vec3 metal = metalReflectance(m, face, base_color, cosine) * gains.metal;
        if (transmitsRough(m))
            keptByGlass(f, lobe, reflected, through);
        else
            reflected *= kept * gains.dielectric;
        reflected = mix(reflected, metal * kept, m.metallic);
    } else if (!transmitsRough(m)) {
        reflected = mix(dielectricAlbedo(m, means, gains), metalAlbedo(m, base_color, means, gains), m.metallic);
    } else if (compensated) {
        reflected = mix(reflected, metalAlbedo(m, base_color, means, gains), m.metallic);
    } else {
        // Seen from inside, no table tells the mean reflectance: then the masking's mean has to do.
        reflected = mix(reflected, metalReflectance(m, face, base_color, cosine), m.metallic) * means.x;
    }
}

/// Red, green and blue each on their own way, where the surface disperses them and the ray has them all.
void disperse(Facet f, Interface face, vec3 incoming, uint channel, inout Branch refraction) {
    if (!dispersive || !face.disperses || channel > 0u) return;
    refraction.dispersed = true;
    // Without a way to go there is no light to go it.
    if (!refractRay(incoming, f.normal, face.etas.r, refraction.red)) refraction.red = refraction.direction;
    if (!refractRay(incoming, f.normal, face.etas.b, refraction.blue)) refraction.blue = refraction.direction;
}

/// RayState::medium of a ray that goes on behind the surface; `medium`: of one before it.
uint mediumBehind(Surface s, Material m, uint medium) {
    medium &= ~RAY_SEES_SUN;
    if (!transmits(m) || (m.flags & MATERIAL_THIN) != 0u) return medium;
    return (s.front ? s.material : MEDIUM_NONE) | (medium & (RAY_PASSES | RAY_CHANNEL));
}

/// Both branches of a surface, and what it sends by itself; `cone`: of the incoming ray at the hit; `emission`: what of it counts.
vec3 scatterSurface(Surface s, vec3 incoming, Interface face, RayState state, vec2 cone, float emission, out Branch reflection, out Branch refraction) {
    reflection = refraction = NO_BRANCH;
    const Material m = materialOf(s);
    vec3 radiance = m.emissive * emission;
    if ((m.flags & MATERIAL_UNLIT) != 0u) {
        radiance = s.base_color;
        passBeside(s, incoming, state, cone, radiance, reflection, refraction);
        return radiance;
    }
    const vec3 view = -incoming;
    const Lobe lobe = lobeOf(s, m, view);
    const Facet facet = facetOf(s, m, lobe, incoming, face, state.seed);
    vec3 reflected, through;
    sharesOf(facet, m, face, s.base_color, lobe, view, reflected, through);
    const float below = belowSheen(m, dot(view, s.normal));
    // After a rough surface the sun's disc is a light, not a thing to be seen: its image in a further mirror would be noise.
    const uint sun = isMirror(lobe) ? state.medium & RAY_SEES_SUN : 0u;
    const uint medium = state.medium & ~RAY_SEES_SUN;
    const vec3 mirrored = aboveSurface(facet.reflected, s.geometric);
    const float density = isSampled(lobe) && !sharesBranch(s, m) ? lobeDensity(lobe, view, normalize(view + mirrored)) : 0.0;
    reflection = branchAlong(reflected * below, mirrored, medium | sun, keptCone(lobeCone(coneReflected(cone, s.curvature), lobe, 1.0)), EFFECT_REFLECTION, density);
    decide(reflection, state, false);
    const bool transparent = transmits(m);
    if (!transparent) radiance += fade(reflection, lobe.roughness, m.metallic);
    reflection.blur = samplesMicrofacets() ? 0.0 : lobe.roughness;

    if (transparent && facet.passes) {
        const bool thin = (m.flags & MATERIAL_THIN) != 0u;
        const uint inside = mediumBehind(s, m, medium);
        // A microfacet turns what it refracts less than what it mirrors, as Snell's law has it near the normal.
        const vec2 beyond = thin ? lobeCone(cone, lobe, 1.0) : lobeCone(coneRefracted(cone, s.curvature, face.eta), lobe, 0.5 * abs(1.0 - 1.0 / face.eta));
        const vec3 direction = thin && isSampled(lobe) ? -aboveSurface(-facet.through, s.geometric) : facet.through;
        refraction = branchAlong(through * transmissionTint(m, s.base_color) * below, direction, inside | sun, keptCone(beyond), EFFECT_REFRACTION,
                                 state.density);
        decide(refraction, state, false);
        disperse(facet, face, incoming, channelOf(state.medium), refraction);
    }
    if (coated && m.clearcoat > 0.0) addCoat(s, m, incoming, state, cone, transparent || s.alpha < 1.0, radiance, reflection, refraction);
    passBeside(s, incoming, state, cone, radiance, reflection, refraction);
    return radiance;
}

#endif
