// Lookups in textures. Include after the buffers they read: texture_infos, texels.
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

vec4 fetchTexel(GpuTexture info, int x, int y) {
    const uint at = info.offset + wrapTexel(y, info.height, info.flags >> 2u & 3u) * info.width + wrapTexel(x, info.width, info.flags & 3u);
    const vec4 encoded = unpackUnorm4x8(texels[at]);
    return vec4(srgbToLinear(encoded.rgb), encoded.a);
}

vec4 sampleTexture(int index, vec2 uv) {
    const GpuTexture info = texture_infos[index];
    // Whole repeats are dropped first: large coordinates would lose the fraction's bits.
    const vec2 wrapped = uv - 2.0 * floor(uv * 0.5);
    const bool clamped_u = (info.flags & 3u) == 2u, clamped_v = (info.flags >> 2u & 3u) == 2u;
    const vec2 p = vec2(clamped_u ? clamp(uv.x, 0.0, 1.0) : wrapped.x, clamped_v ? clamp(uv.y, 0.0, 1.0) : wrapped.y) * vec2(info.width, info.height);
    if ((info.flags & 16u) != 0u) return fetchTexel(info, int(floor(p.x)), int(floor(p.y)));
    const vec2 q = p - 0.5, f = fract(q);
    const ivec2 i = ivec2(floor(q));
    const vec4 top = mix(fetchTexel(info, i.x, i.y), fetchTexel(info, i.x + 1, i.y), f.x);
    const vec4 bottom = mix(fetchTexel(info, i.x, i.y + 1), fetchTexel(info, i.x + 1, i.y + 1), f.x);
    return mix(top, bottom, f.y);
}

#endif
