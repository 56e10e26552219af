// What rough surfaces and sheens reflect of white light, from the tables. Include after the scene's buffers.
#ifndef PEELRAY_TABLES_GLSL
#define PEELRAY_TABLES_GLSL

#include "path/interface.glsl"
#include "path/lobe.glsl"
#include "path/tables.h"

/// A square table's entry for a roughness and a cosine, bilinear in their square roots.
vec4 tabulated(uint table, uint side, float roughness, float cosine) {
    const vec2 at = sqrt(clamp(vec2(cosine, roughness), vec2(0), vec2(1))) * float(side - 1u);
    const uvec2 i = min(uvec2(at), uvec2(side - 2u));
    const vec2 f = at - vec2(i);
    const uint first = table + i.y * side + i.x, next = first + side;
    return mix(mix(lookups[first], lookups[first + 1u], f.x), mix(lookups[next], lookups[next + 1u], f.x), f.y);
}

/// The means of the split sum; the first is that of the masking: what is left of white light.
vec4 splitSum(float roughness, float cosine) { return tabulated(TABLE_SPLIT_SUM, SPLIT_SUM_SIDE, roughness, cosine); }

/// What light that is scattered more than once adds to what is scattered once, as a factor, by reflectance at normal incidence and the
/// mean masking (Turquin: Practical Multiple Scattering Compensation for Microfacet Models, 2019).
vec3 compensation(vec3 f0, float kept) { return 1.0 + f0 * ((1.0 - kept) / kept); }

/// Shares of white light that the dielectric part and the metal of a rough surface reflect.
struct Albedos {
    vec3 dielectric, metal;
    vec3 dielectric_gain, metal_gain;  ///< of it: what is scattered more than once, as factors
    float kept;  ///< mean masking
};

/// `cosine`: between the view and the normal.
Albedos albedosOf(Material m, vec3 base_color, Lobe lobe, float cosine) {
    const vec4 means = splitSum(lobe.mean_roughness, cosine);
    Albedos a;
    a.kept = means.x;
    a.dielectric = (m.flags & MATERIAL_SCHLICK) != 0u ? m.f0 * means.x + (m.f90 - m.f0) * means.z
                                                      : vec3(clamp(m.f0.x * means.x + dot(m.fresnel_fit, means.yzw), 0.0, 1.0));
    a.metal = base_color * means.x + (1.0 - base_color) * means.z;
    vec3 f0 = normalReflectance(m), metal_f0 = base_color;
    if (filmed && m.iridescence > 0.0) {
        // Where the microfacets are that have Schlick's mean: at grazing angles the normal's own says too much.
        const float mean = 1.0 - pow(clamp(means.z / means.x, 0.0, 1.0), 0.2);
        const vec3 film = filmReflectance(m, filmBase(m), mean), metal_film = filmReflectance(m, metalIndex(base_color), mean);
        a.dielectric = mix(a.dielectric, film * means.x, m.iridescence);
        a.metal = mix(a.metal, metal_film * means.x, m.iridescence);
        f0 = mix(f0, film, m.iridescence);
        metal_f0 = mix(metal_f0, metal_film, m.iridescence);
    }
    a.dielectric_gain = a.metal_gain = vec3(1);
    if ((frame[0].effects & EFFECT_COMPENSATION) != 0u) {
        a.dielectric_gain = compensation(f0, means.x);
        a.metal_gain = compensation(metal_f0, means.x);
        a.dielectric *= a.dielectric_gain;
        a.metal *= a.metal_gain;
    }
    return a;
}

/// Share of the light that a clear coat mirrors, and keeps from what is below it; `cosine`: between the view and the coat's normal.
float coatShare(Material m, float cosine) {
    if (!coated || m.clearcoat == 0.0) return 0.0;
    cosine = clamp(cosine, 0.0, 1.0);
    if (m.coat_roughness < MIRROR_ROUGHNESS) return m.clearcoat * fresnelSchlick(vec3(COAT_REFLECTANCE), 1.0, cosine).x;
    const vec4 means = splitSum(m.coat_roughness, cosine);
    return m.clearcoat * (COAT_REFLECTANCE * means.x + (1.0 - COAT_REFLECTANCE) * means.z);
}

/// Share of white light that a material's sheen reflects (KHR_materials_sheen); `cosine`: between the light, or the view, and the normal.
vec3 sheenAlbedo(Material m, float cosine) {
    if (!sheened || m.sheen_color == vec3(0)) return vec3(0);
    return m.sheen_color * tabulated(TABLE_SHEEN, SHEEN_SIDE, m.sheen_roughness, cosine).x;
}

/// What a sheen leaves for what is below it.
float belowSheen(Material m, float cosine) { return 1.0 - largest(sheenAlbedo(m, cosine)); }

#endif
