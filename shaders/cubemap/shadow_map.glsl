// Shadow maps by percentage-closer filtering (Reeves, Salesin, Cook: Rendering Antialiased Shadows with Depth Maps, 1987),
// without bindings. Define SHADOW_DEPTH(index) before including: the depth of a texel.
#ifndef PEELRAY_SHADOW_MAP_GLSL
#define PEELRAY_SHADOW_MAP_GLSL

#include "cubemap/cubemap_params.h"

/// Depth of the plane through `p` with normal `n` at the place q of a map; `p` relative to the eye, q in [-1, 1]².
/// Infinite where the light's ray does not meet the plane's lit side.
float planeDepth(GpuShadowMap map, vec3 p, vec3 n, vec2 q) {
    const vec3 offset = map.right * q.x + map.up * q.y;
    const float facing = dot(n, map.orthographic != 0u ? map.forward : map.forward + offset);
    const float distance = dot(n, map.orthographic != 0u ? p - offset : p);
    return facing < 0.0 && distance < 0.0 ? distance / facing : uintBitsToFloat(0x7f800000u);
}

/// Share of a light that arrives at `position` on a surface whose plane has the unit normal `normal`, on the light's side:
/// 3x3 taps with bilinear weights. Each is compared with the depth of the surface's own plane at the tap, so that a plane does
/// not shadow itself however slanted it is (Isidoro: Shadow Mapping, GPU-based Tips and Tricks, GDC 2006), but never with a
/// greater depth than the point's own, so that the far side of a corner does not darken it.
float shadowMapShare(GpuShadowMap map, vec3 position, vec3 normal, vec3 to_light) {
    if (map.size == 0u) return 1.0;
    vec3 p = position - map.eye;
    const float scale = map.orthographic != 0u ? 1.0 : dot(p, map.forward);
    // A texel's size at the point. What is left to the bias are curved surfaces: along the normal, more the more grazing the
    // light is, and half a texel towards the light.
    const float texel = 2.0 * max(length(map.right), length(map.up)) * scale / float(map.size);
    const float cosine = clamp(dot(normal, to_light), 0.0, 1.0);
    p += normal * (texel * sqrt(1.0 - cosine * cosine));
    const float depth = dot(p, map.forward);
    if (depth <= 0.0) return 1.0;
    const float bias = 0.5 * texel + 1e-5 * depth;
    vec2 q = vec2(dot(p, map.right) / dot(map.right, map.right), dot(p, map.up) / dot(map.up, map.up));
    if (map.orthographic == 0u) q /= depth;
    const vec2 at = (vec2(q.x, -q.y) * 0.5 + 0.5) * float(map.size) - 0.5, f = fract(at);
    const ivec2 corner = ivec2(floor(at)) - 1;
    const vec4 weight_x = vec4(1.0 - f.x, 1.0, 1.0, f.x) / 3.0, weight_y = vec4(1.0 - f.y, 1.0, 1.0, f.y) / 3.0;
    float lit = 0.0;
    for (int y = 0; y < 4; y++)
        for (int x = 0; x < 4; x++) {
            const ivec2 tap = corner + ivec2(x, y);
            const vec2 place = (vec2(tap) + 0.5) * (2.0 / float(map.size)) - 1.0;
            const float own = min(depth, planeDepth(map, p, normal, vec2(place.x, -place.y)));
            const bool inside = tap.x >= 0 && tap.y >= 0 && tap.x < int(map.size) && tap.y < int(map.size);
            const ivec2 nearest = clamp(tap, ivec2(0), ivec2(map.size - 1u));
            const float blocker = SHADOW_DEPTH(map.first + uint(nearest.y) * map.size + uint(nearest.x));
            if (!inside || blocker >= own - bias) lit += weight_x[x] * weight_y[y];
        }
    return lit;
}

#endif
