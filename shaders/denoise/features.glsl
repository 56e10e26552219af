// What a pixel shows, as the denoiser compares it: uvec4, once for all passes.
//   x  normal, octahedral, 16 bits each
//   y  depth; 0: nothing here is to be filtered
//   z  how the depth rises to the right and down, over the depth, halves
//   w  gloss, luminance of the albedo, halves
#ifndef PEELRAY_DENOISE_FEATURES_GLSL
#define PEELRAY_DENOISE_FEATURES_GLSL

#include "denoise/denoise_params.h"
#include "path/shading.glsl"

/// A unit vector folded into a square (Meyer et al., 2010).
uint packNormal(vec3 n) {
    vec2 p = n.xy / (abs(n.x) + abs(n.y) + abs(n.z));
    if (n.z < 0.0) p = (1.0 - abs(p.yx)) * vec2(p.x >= 0.0 ? 1.0 : -1.0, p.y >= 0.0 ? 1.0 : -1.0);
    return packSnorm2x16(p);
}

vec3 unpackNormal(uint packed) {
    const vec2 p = unpackSnorm2x16(packed);
    vec3 n = vec3(p, 1.0 - abs(p.x) - abs(p.y));
    const float fold = max(-n.z, 0.0);
    n.xy += vec2(n.x >= 0.0 ? -fold : fold, n.y >= 0.0 ? -fold : fold);
    return normalize(n);
}

/// What taps are compared with.
struct Features {
    vec3 normal;
    float depth;
    vec2 slope;
    vec2 look;  ///< gloss, luminance of the albedo
};

Features unpackFeatures(uvec4 packed) {
    return Features(unpackNormal(packed.x), uintBitsToFloat(packed.y), unpackHalf2x16(packed.z), unpackHalf2x16(packed.w));
}

bool isFiltered(uvec4 packed) { return packed.y != 0u; }

/// How unlike a tap's guides are to the pixel's: the exponent by which its weight falls; `offset`: to it, pixels.
float unlikeness(Features pixel, uvec4 tap, ivec2 offset) {
    const float turn = 1.0 - dot(pixel.normal, unpackNormal(tap.x)), depth = uintBitsToFloat(tap.y);
    const float rise = dot(pixel.slope, vec2(offset)) * pixel.depth;
    const float tolerance = DENOISE_SLOPE_TOLERANCE * abs(rise) + DENOISE_DEPTH_TOLERANCE * pixel.depth;
    const vec2 look = abs(unpackHalf2x16(tap.w) - pixel.look);
    return DENOISE_NORMAL_FALL * turn + abs(depth - pixel.depth - rise) / tolerance + dot(look, vec2(DENOISE_GLOSS_FALL, DENOISE_ALBEDO_FALL));
}

#endif
