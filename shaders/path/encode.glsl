// What a display shows of a pixel: exposure, tone curve and sRGB encoding. Wants path/shading.glsl.

uint encode(vec3 radiance, float scale, uint curve) {
    vec3 color = radiance * scale;
    if (curve == 1u) color = tonemapAces(color);
    if (curve == 2u) color = tonemapNeutral(color);
    return packUnorm4x8(vec4(linearToSrgb(clamp(color, vec3(0), vec3(1))), 1));
}
