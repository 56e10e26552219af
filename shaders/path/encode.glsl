// What a display shows of a pixel: exposure, tone curve and sRGB encoding. Wants path/shading.glsl.

/// What unlit colours are of a pixel's `sum` over the samples.
vec3 unlitShare(vec3 unlit, vec3 sum) { return mix(unlit / max(sum, vec3(1e-30)), vec3(0), lessThanEqual(sum, vec3(0))); }

/// `sum` over the samples, of which the share `unlit` is to be shown as it is; `scale`: exposure / samples, `share`: 1 / samples.
/// `straight`: with an alpha, and in the colour of the part that is covered; else opaque.
uint encode(vec4 sum, vec3 unlit, float scale, float share, uint curve, bool straight) {
    float alpha = 1.0;
    if (straight) {
        alpha = clamp(sum.a * share, 0.0, 1.0);
        if (alpha == 0.0) return 0u;
        scale /= alpha;
        share /= alpha;
    }
    vec3 color = sum.rgb * (1.0 - unlit) * scale;
    if (curve == 1u) color = tonemapAces(color);
    if (curve == 2u) color = tonemapNeutral(color);
    color += sum.rgb * unlit * share;
    return packUnorm4x8(vec4(linearToSrgb(clamp(color, vec3(0), vec3(1))), alpha));
}
