// What a display shows of a pixel: exposure, tone curve and sRGB encoding. Wants path/shading.glsl.

/// What unlit colours are of a pixel's `sum` over the samples.
vec3 unlitShare(vec3 unlit, vec3 sum) { return mix(unlit / max(sum, vec3(1e-30)), vec3(0), lessThanEqual(sum, vec3(0))); }

/// `sum` over the samples, of which the share `unlit` is to be shown as it is; `scale`: exposure / samples, `share`: 1 / samples.
uint encode(vec3 sum, vec3 unlit, float scale, float share, uint curve) {
    vec3 color = sum * (1.0 - unlit) * scale;
    if (curve == 1u) color = tonemapAces(color);
    if (curve == 2u) color = tonemapNeutral(color);
    color += sum * unlit * share;
    return packUnorm4x8(vec4(linearToSrgb(clamp(color, vec3(0), vec3(1))), 1));
}
