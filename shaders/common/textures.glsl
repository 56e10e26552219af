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

vec4 sampleTexture(GpuTexture info, vec2 uv) {
    // Whole repeats are dropped first: large coordinates would lose the fraction's bits.
    const vec2 wrapped = uv - 2.0 * floor(uv * 0.5);
    const bool clamped_u = (info.flags & 3u) == 2u, clamped_v = (info.flags >> 2u & 3u) == 2u;
    const vec2 p = vec2(clamped_u ? clamp(uv.x, 0.0, 1.0) : wrapped.x, clamped_v ? clamp(uv.y, 0.0, 1.0) : wrapped.y) * vec2(info.width, info.height);
    if ((info.flags & USE_NEAREST) != 0u) return fetchTexel(info, int(floor(p.x)), int(floor(p.y)));
    const vec2 q = p - 0.5, f = fract(q);
    const ivec2 i = ivec2(floor(q));
    const vec4 top = mix(fetchTexel(info, i.x, i.y), fetchTexel(info, i.x + 1, i.y), f.x);
    const vec4 bottom = mix(fetchTexel(info, i.x, i.y + 1), fetchTexel(info, i.x + 1, i.y + 1), f.x);
    return mix(top, bottom, f.y);
}

/// At coordinates that were interpolated; the texture's own transform comes here.
vec4 sampleMoved(GpuTexture info, vec2 uv) {
    if ((info.flags & USE_MOVED) != 0u) uv = info.u_axis * uv.x + info.v_axis * uv.y + info.uv_offset;
    return sampleTexture(info, uv);
}

/// At the weights of a triangle's corners.
vec4 textureAt(int index, uvec3 corners, vec3 weights) {
    const GpuTexture info = texture_infos[index];
    corners += info.first_uv;
    return sampleMoved(info, uvs[corners.x] * weights.x + uvs[corners.y] * weights.y + uvs[corners.z] * weights.z);
}

#endif
