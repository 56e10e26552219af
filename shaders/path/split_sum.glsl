// What a rough surface reflects of white light, from the table of split_sum.h. Include after the buffer split_sum.
#ifndef PEELRAY_SPLIT_SUM_GLSL
#define PEELRAY_SPLIT_SUM_GLSL

#include "common/material.glsl"
#include "path/split_sum.h"

/// The table's four means, bilinear.
vec4 splitSum(float roughness, float cosine) {
    const vec2 at = sqrt(clamp(vec2(cosine, roughness), vec2(0), vec2(1))) * float(SPLIT_SUM_SIDE - 1);
    const uvec2 i = min(uvec2(at), uvec2(SPLIT_SUM_SIDE - 2));
    const vec2 f = at - vec2(i);
    const uint first = i.y * SPLIT_SUM_SIDE + i.x, next = first + SPLIT_SUM_SIDE;
    return mix(mix(split_sum[first], split_sum[first + 1u], f.x), mix(split_sum[next], split_sum[next + 1u], f.x), f.y);
}

/// Share of white light that the dielectric part of a rough surface reflects.
vec3 dielectricAlbedo(Material m, vec4 means) {
    const vec3 schlick = m.f0 * means.x + (m.f90 - m.f0) * means.z;
    return (m.flags & MATERIAL_SCHLICK) != 0u ? schlick : vec3(clamp(m.f0.x * means.x + dot(m.fresnel_fit, means.yzw), 0.0, 1.0));
}

/// Share of the light that a clear coat mirrors, and keeps from what is below it; `cosine`: between the view and the coat's normal.
float coatShare(Material m, float cosine) {
    if (!coated || m.clearcoat == 0.0) return 0.0;
    cosine = clamp(cosine, 0.0, 1.0);
    if (m.coat_roughness < MIRROR_ROUGHNESS) return m.clearcoat * fresnelSchlick(vec3(COAT_REFLECTANCE), 1.0, cosine).x;
    const vec4 means = splitSum(m.coat_roughness, cosine);
    return m.clearcoat * (COAT_REFLECTANCE * means.x + (1.0 - COAT_REFLECTANCE) * means.z);
}

/// Share of white light that a rough metal reflects.
vec3 metalAlbedo(vec3 base_color, vec4 means) { return base_color * means.x + (1.0 - base_color) * means.z; }

#endif
