// What a display shows of a pixel: exposure, tone curve and sRGB encoding. Wants path/shading.glsl.

/// `sum` over the samples, of which the share `unlit` is to be shown as it is; `scale`: exposure / samples, `share`: 1 / samples.
uint encode(vec3 sum, vec3 unlit, float scale, float share, uint curve) {
    vec3 color = sum * (1.0 - unlit) * scale;
    if (curve == 1u) color = tonemapAces(color);
    if (curve == 2u) color = tonemapNeutral(color);
    color += sum * unlit * share;
    return packUnorm4x8(vec4(linearToSrgb(clamp(color, vec3(0), vec3(1))), 1));
}
