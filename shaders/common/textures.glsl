// Lookups in textures. Include after what they read: texture_infos, texels, uvs.
#ifndef PEELRAY_TEXTURES_GLSL
#define PEELRAY_TEXTURES_GLSL

#include "common/material.h"

#include "path/shading.glsl"

uint wrapTexel(int i, uint size, uint mode) {
    const int n = int(size);
    if (mode == 2u) return uint(clamp(i, 0, n - 1));
    // From -1 on; of negative numbers GLSL leaves the remainder undefined, and devices differ.
    if (mode == 0u) return uint((i + n) % n);
    const int m = (i + 2 * n) % (2 * n);
    return uint(m < n ? m : 2 * n - 1 - m);
}

uint texelWord(uint at) {
    const uvec3 place = uvec3(at, at >> TEXEL_ROW_BITS, at >> TEXEL_LAYER_BITS);
    const uvec2 within = place.xy & uvec2((1u << TEXEL_ROW_BITS) - 1u, (1u << (TEXEL_LAYER_BITS - TEXEL_ROW_BITS)) - 1u);
    return texelFetch(texels, ivec3(within, place.z), 0).r;
}

vec4 fetchTexel(GpuTexture info, int x, int y) {
    const uint at = wrapTexel(y, info.height, info.flags >> 2u & 3u) * info.width + wrapTexel(x, info.width, info.flags & 3u);
    vec4 encoded;
    if ((info.flags & USE_DEEP) != 0u)
        encoded = vec4(unpackUnorm2x16(texelWord(info.offset + 2u * at)), unpackUnorm2x16(texelWord(info.offset + 2u * at + 1u)));
    else
        encoded = unpackUnorm4x8(texelWord(info.offset + at));
    return (info.flags & USE_DATA) != 0u ? encoded : vec4(srgbToLinear(encoded.rgb), encoded.a);
}

/// One level, bilinear or the nearest texel. Here and below loops stand for what could be written out: each place that is called is
/// code that compilers copy into every use of a texture.
vec4 sampleLevel(GpuTexture info, vec2 uv, bool nearest) {
    // Whole repeats are dropped first: large coordinates would lose the fraction's bits.
    const vec2 wrapped = uv - 2.0 * floor(uv * 0.5);
    const bool clamped_u = (info.flags & 3u) == 2u, clamped_v = (info.flags >> 2u & 3u) == 2u;
    const vec2 p = vec2(clamped_u ? clamp(uv.x, 0.0, 1.0) : wrapped.x, clamped_v ? clamp(uv.y, 0.0, 1.0) : wrapped.y) * vec2(info.width, info.height);
    const vec2 q = nearest ? floor(p) : p - 0.5, f = fract(q);
    const ivec2 first = ivec2(floor(q));
    vec4 sum = vec4(0);
    for (int i = 0; i < (nearest ? 1 : 4); i++) {
        const ivec2 corner = ivec2(i & 1, i >> 1);
        const vec2 share = mix(1.0 - f, f, bvec2(corner));
        sum += share.x * share.y * fetchTexel(info, first.x + corner.x, first.y + corner.y);
    }
    return sum;
}

/// Level `number` as a texture of its own.
GpuTexture textureLevel(GpuTexture info, uint number) {
    for (uint i = 1u; i <= number; i++) {
        info.offset = i == 1u ? info.smaller : info.offset + info.width * info.height * ((info.flags & USE_DEEP) != 0u ? 2u : 1u);
        info.width = max(info.width >> 1u, 1u);
        info.height = max(info.height >> 1u, 1u);
    }
    return info;
}

/// Filtered for a footprint whose width in texels has the binary logarithm `lod`; at most 0: magnified.
vec4 sampleTexture(GpuTexture info, vec2 uv, float lod) {
    const bool nearest = (info.flags & (lod > 0.0 ? USE_MIN_NEAREST : USE_NEAREST)) != 0u;
    lod = lod > 0.0 && (info.flags & USE_LEVELS) != 0u ? min(lod, float(findMSB(max(info.width, info.height)))) : 0.0;
    if ((info.flags & USE_BETWEEN) == 0u) lod = ceil(lod - 0.5);
    const float part = fract(lod);
    vec4 sum = vec4(0);
    for (uint k = 0u; k < (part > 0.0 ? 2u : 1u); k++)
        sum += (k == 0u ? 1.0 - part : part) * sampleLevel(textureLevel(info, uint(lod) + k), uv, nearest);
    return sum;
}

/// Where the texture's own transform takes coordinates.
vec2 movedCoordinates(GpuTexture info, vec2 uv) {
    return (info.flags & USE_MOVED) != 0u ? info.u_axis * uv.x + info.v_axis * uv.y + info.uv_offset : uv;
}

/// A place in a triangle as textures see it.
struct TexturePlace {
    uvec3 corners;
    vec3 weights;
    float seen;  ///< area of what the ray stands for, over twice that of the triangle; 0: a point
};

vec4 textureAt(int index, TexturePlace place) {
    const GpuTexture info = texture_infos[index];
    const uvec3 at = place.corners + info.first_uv;
    const vec2 a = uvs[at.x], b = uvs[at.y], c = uvs[at.z];
    float lod = -1.0;
    if (place.seen > 0.0) {
        float texels = float(info.width) * float(info.height) * abs(determinant(mat2(b - a, c - a)));
        if ((info.flags & USE_MOVED) != 0u) texels *= abs(determinant(mat2(info.u_axis, info.v_axis)));
        lod = 0.5 * log2(max(place.seen * texels, 1e-30));
    }
    return sampleTexture(info, movedCoordinates(info, a * place.weights.x + b * place.weights.y + c * place.weights.z), lod);
}

#endif
