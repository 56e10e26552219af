// Light on a surface: lamps, sun and diffuse sky. Include after frame.glsl and the buffers of lights and split_sum.
#ifndef PEELRAY_LIGHTING_GLSL
#define PEELRAY_LIGHTING_GLSL

#include "path/frame.h"
#include "path/interface.glsl"
#include "path/split_sum.glsl"

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

/// The lobe of GGX around a normal, times the cosine; less Fresnel's share.
float highlight(vec3 normal, float roughness, vec3 view, vec3 to_light, vec3 h) {
    const float n_l = dot(normal, to_light);
    if (n_l <= 0.0 || roughness < MIRROR_ROUGHNESS) return 0.0;
    const float n_v = max(GRAZING_COSINE, dot(normal, view)), n_h = clamp(dot(normal, h), 0.0, 1.0), alpha = roughness * roughness;
    return ggxDistribution(n_h, alpha) * ggxMasking(n_v, alpha) * ggxMasking(n_l, alpha) / (4.0 * n_v);
}

/// Reflected share of light from `to_light`, times the cosine.
vec3 reflectance(Surface s, Material m, vec3 view, vec3 to_light) {
    const vec3 h = normalize(view + to_light);
    const float n_l = dot(s.normal, to_light), v_h = clamp(dot(view, h), 0.0, 1.0);
    vec3 result = vec3(0);
    if (n_l > 0.0) {
        const vec3 dielectric = dielectricReflectance(m, v_h, leavesVolume(m, s.front));
        result = (1.0 - m.metallic) * (1.0 - m.transmission) * (1.0 - largest(dielectric)) * s.base_color / PI * n_l;
        if (m.roughness >= MIRROR_ROUGHNESS)
            result += mix(dielectric, fresnelSchlick(s.base_color, 1.0, v_h), m.metallic) * highlight(s.normal, m.roughness, view, to_light, h);
    }
    if (!coated || m.clearcoat == 0.0) return result;
    return result * (1.0 - coatShare(m, dot(view, s.coat_normal))) +
           m.clearcoat * fresnelSchlick(vec3(COAT_REFLECTANCE), 1.0, v_h) * highlight(s.coat_normal, m.coat_roughness, view, to_light, h);
}

/// Light of a lamp or the sun that the surface sends towards `view`, if nothing is in its way; `direction`: to the light. The
/// shading normal alone says whether the surface faces the light: the triangle's would cut it off in facets.
vec3 lampLight(uint index, Surface s, Material m, vec3 view, out vec3 direction) {
    float distance;
    const vec3 light = lightAt(lights[index], s.position, direction, distance);
    return light == vec3(0) ? light : light * reflectance(s, m, view, direction);
}

/// Diffuse light of the sky that the surface sends towards `view`, if it sees all of it.
vec3 skyLight(Surface s, Material m, vec3 view) {
    const vec3 diffuse = (1.0 - m.metallic) * (1.0 - m.transmission) * s.base_color / PI;
    if (diffuse == vec3(0)) return vec3(0);
    // What the surface mirrors is not available for diffuse light: the share that scatter.comp gives to the reflection.
    const float cosine = clamp(dot(view, s.normal), 0.0, 1.0);
    const vec3 mirrored = m.roughness < MIRROR_ROUGHNESS ? dielectricReflectance(m, cosine, leavesVolume(m, s.front))
                                                         : dielectricAlbedo(m, splitSum(m.roughness, cosine));
    return diffuse * m.occlusion * (1.0 - largest(mirrored)) * (1.0 - coatShare(m, dot(view, s.coat_normal))) * environmentIrradiance(s.normal);
}

#endif
