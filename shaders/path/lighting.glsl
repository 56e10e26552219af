// Light on a surface: lamps, sun and diffuse sky. Include after frame.glsl and the buffer lights.
#ifndef PEELRAY_LIGHTING_GLSL
#define PEELRAY_LIGHTING_GLSL

#include "caustics/followed.glsl"
#include "path/ball.glsl"
#include "path/frame.h"
#include "path/interface.glsl"
#include "path/lobe.glsl"
#include "path/tables.glsl"

/// Where the light of a lamp or the sun comes from.
struct Incidence {
    vec3 irradiance;  ///< on a surface that faces it, if nothing is in its way
    vec3 direction;   ///< to it
};

/// `soft`: from a point of the light that `random` chooses, else from its centre.
Incidence lightAt(GpuLight light, vec3 position, bool soft, vec2 random) {
    Incidence at = Incidence(light.color, -light.direction);
    float sine = light.sine;
    if (light.kind != 0u) {
        const vec3 to_light = light.position - position;
        const float distance2 = dot(to_light, to_light), distance = sqrt(distance2);
        if (distance == 0.0) return Incidence(vec3(0), at.direction);
        at.direction = to_light / distance;
        // KHR_lights_punctual: inverse square with a smooth end at the range.
        const float r = distance / light.range, r2 = r * r;
        float strength = clamp(1.0 - r2 * r2, 0.0, 1.0) / distance2;
        if (light.kind == 2u) {
            const float cone = clamp(dot(light.direction, -at.direction) * light.cone_scale + light.cone_offset, 0.0, 1.0);
            strength *= cone * cone;
        }
        at.irradiance *= strength;
        sine = min(1.0, sine / distance);
    }
    if (!soft || sine == 0.0) return at;
    float share;
    at.direction = directionToBall(at.direction, sine, random, share);
    at.irradiance *= share;
    return at;
}

/// What a surface makes of light, wherever it comes from.
struct Shade {
    Lobe lobe;
    vec3 diffuse;   ///< share of light that comes out evenly in front, over π
    vec3 seeping;   ///< the same behind
    Gains gains;    ///< of highlights
    float below_coat, below_sheen;     ///< shares that these leave
};

Shade shadeOf(Surface s, Material m, vec3 view) {
    Shade shade;
    shade.lobe = lobeOf(s, m, view);
    const float cosine = clamp(dot(view, s.normal), 0.0, 1.0);
    shade.gains = Gains(vec3(1), vec3(1));
    if (!isMirror(shade.lobe)) shade.gains = gainsOf(m, s.base_color, splitSum(shade.lobe.mean_roughness, cosine));
    const vec3 scattered = vec3((1.0 - m.metallic) * (1.0 - m.transmission) / PI);
    shade.diffuse = scattered * s.base_color;
    shade.seeping = vec3(0);
    if (seeping && m.seeping_share > 0.0) {
        shade.seeping = scattered * m.seeping_share * m.seeping_color * exp(-m.absorption * m.thickness);
        shade.diffuse *= 1.0 - m.seeping_share;
    }
    shade.below_coat = 1.0 - coatShare(m, dot(view, s.coat_normal));
    shade.below_sheen = belowSheen(m, cosine);
    return shade;
}

/// What the dielectric part of the surface leaves, of light from all around, for what is scattered.
float leftByMirroring(Surface s, Material m, Shade shade, vec3 view) {
    const float cosine = clamp(dot(view, s.normal), 0.0, 1.0);
    if (!isMirror(shade.lobe) && !transmitsRough(m))
        return 1.0 - largest(dielectricAlbedo(m, splitSum(shade.lobe.mean_roughness, cosine), shade.gains));
    vec3 mirrored = interfaceReflectance(m, interfaceInAir(m, s.front, CHANNEL_MIDDLE), cosine);
    if (frosted && !isMirror(shade.lobe) && (frame[0].effects & EFFECT_COMPENSATION) == 0u) mirrored *= splitSum(shade.lobe.mean_roughness, cosine).x;
    return 1.0 - largest(mirrored);
}

/// Does the surface's other side send light from there?
bool lightSeeps(Surface s, Shade shade, vec3 to_light) { return seeping && shade.seeping != vec3(0) && dot(s.normal, to_light) < 0.0; }

/// What a microfacet of rough glass reflects of what its two ways keep (keptByGlass), over what it reflects without compensation.
vec3 glassGain(Material m, Interface face, Lobe lobe, vec3 view, vec3 to_light, vec3 h, vec3 reflectance) {
    if ((frame[0].effects & (EFFECT_COMPENSATION | EFFECT_SAMPLED)) != (EFFECT_COMPENSATION | EFFECT_SAMPLED)) return vec3(1);
    vec3 through;
    bool passes = true;
    if ((m.flags & MATERIAL_THIN) != 0u)
        through = reflect(to_light, lobe.normal);
    else
        passes = refractRay(-view, h, face.eta, through);
    return 1.0 / max(reflectance * masking(lobe, to_light) + (1.0 - reflectance) * (passes ? masking(lobe, -through) : 0.0), vec3(1e-6));
}

/// Of the light from `to_light` that a sheen sends to `view`, times the cosine.
vec3 sheenReflectance(Surface s, Material m, vec3 view, vec3 to_light, vec3 h) {
    if (!sheened || m.sheen_color == vec3(0)) return vec3(0);
    const float rough = max(m.sheen_roughness, SHEEN_LEAST_ROUGHNESS), alpha = rough * rough;
    const float n_l = dot(s.normal, to_light), n_v = max(GRAZING_COSINE, dot(s.normal, view));
    return m.sheen_color * sheenDistribution(clamp(dot(s.normal, h), 0.0, 1.0), alpha) / ((1.0 + sheenLambda(n_v, alpha) + sheenLambda(n_l, alpha)) * 4.0 * n_v);
}

/// Of the base's lobe, without what lies above it; the surface faces the light. `h`: half-way between `view` and `to_light`.
vec3 baseHighlight(Surface s, Material m, Shade shade, vec3 view, vec3 to_light, vec3 h) {
    if (isMirror(shade.lobe)) return vec3(0);
    const float v_h = clamp(dot(view, h), 0.0, 1.0);
    const Interface face = interfaceInAir(m, s.front, CHANNEL_MIDDLE);
    const vec3 dielectric = interfaceReflectance(m, face, v_h);
    vec3 gain = shade.gains.dielectric;
    if (transmitsRough(m)) gain = glassGain(m, face, shade.lobe, view, to_light, h, dielectric);
    return mix(dielectric * gain, metalReflectance(m, face, s.base_color, v_h) * shade.gains.metal, m.metallic) * highlight(shade.lobe, view, to_light, h);
}

vec3 coatHighlight(Surface s, Material m, vec3 view, vec3 to_light, vec3 h) {
    return m.clearcoat * fresnelSchlick(vec3(COAT_REFLECTANCE), 1.0, clamp(dot(view, h), 0.0, 1.0)) *
           highlight(roundLobe(s.coat_normal, m.coat_roughness), view, to_light, h);
}

// True: what lobes mirror that photons follow is left out, for these bring it.
#ifndef LOBES_BROUGHT
#define LOBES_BROUGHT false
#endif

/// Reflected share of light from `to_light`, times the cosine; of what seeps through the share of light from behind.
vec3 reflectance(Surface s, Material m, Shade shade, vec3 view, vec3 to_light) {
    const float n_l = dot(s.normal, to_light);
    if (lightSeeps(s, shade, to_light))
        return shade.seeping * -n_l * leftByMirroring(s, m, shade, view) * shade.below_sheen * shade.below_coat;
    const vec3 h = normalize(view + to_light);
    vec3 result = vec3(0);
    if (n_l > 0.0) {
        const vec3 dielectric = interfaceReflectance(m, interfaceInAir(m, s.front, CHANNEL_MIDDLE), clamp(dot(view, h), 0.0, 1.0));
        result = (1.0 - largest(dielectric)) * shade.diffuse * n_l;
        if (!LOBES_BROUGHT || !photonsFollow(m, shade.lobe.roughness)) result += baseHighlight(s, m, shade, view, to_light, h);
        if (sheened) result = result * min(shade.below_sheen, belowSheen(m, n_l)) + sheenReflectance(s, m, view, to_light, h);
    }
    if (!coated || m.clearcoat == 0.0) return result;
    result *= shade.below_coat;
    return LOBES_BROUGHT && photonsFollow(m.coat_roughness, 0.0) ? result : result + coatHighlight(s, m, view, to_light, h);
}

/// The same of the environment's light by all for which no ray is traced: what is scattered, the sheen, and what seeps through. As of the
/// sky's light, what the surface mirrors on the whole is not available for it.
vec3 scatteredShare(Surface s, Material m, Shade shade, vec3 view, vec3 to_light) {
    const float n_l = dot(s.normal, to_light);
    vec3 share = n_l > 0.0 ? shade.diffuse * n_l : (seeping ? shade.seeping * -n_l : vec3(0));
    if (share != vec3(0)) share *= leftByMirroring(s, m, shade, view) * shade.below_sheen;
    if (n_l > 0.0) share += sheenReflectance(s, m, view, to_light, normalize(view + to_light));
    return share * shade.below_coat;
}

/// Light of a lamp or the sun that the surface sends towards `view`, if nothing is in its way; `direction`: to the light. The
/// shading normal alone says whether the surface faces the light: the triangle's would cut it off in facets.
vec3 lampLight(uint index, Surface s, Material m, Shade shade, vec3 view, bool soft, vec2 random, out vec3 direction) {
    const Incidence at = lightAt(lights[index], s.position, soft, random);
    direction = at.direction;
    return at.irradiance == vec3(0) ? vec3(0) : at.irradiance * reflectance(s, m, shade, view, direction);
}

/// Diffuse light of the sky that the surface sends towards `view`, if it sees all of it: of what is in front, and of what is behind.
void skyLight(Surface s, Material m, Shade shade, vec3 view, out vec3 front, out vec3 behind) {
    // What the surface mirrors is not available for diffuse light: the share that scatter.comp gives to the reflection. Where rays find
    // what is in the way, the texture that says so is left out.
    const float open = (frame[0].effects & EFFECT_AMBIENT) != 0u ? 1.0 : m.occlusion;
    front = behind = vec3(0);
    vec3 share = vec3(0), left = vec3(0);
    if (shade.diffuse != vec3(0) || shade.seeping != vec3(0)) {
        left = open * vec3(leftByMirroring(s, m, shade, view) * shade.below_sheen * shade.below_coat);
        share = shade.diffuse * left;
    }
    if (sheened) share += sheenAlbedo(m, dot(view, s.normal)) / PI * (open * shade.below_coat);
    if (share != vec3(0)) front = share * environmentIrradiance(s.normal);
    if (seeping && shade.seeping != vec3(0)) behind = shade.seeping * left * environmentIrradiance(-s.normal);
}

#endif
