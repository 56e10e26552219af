// A level of a probe blurred to a roughness: GGX importance sampling with view = normal = mirror direction (Karis: Real Shading
// in Unreal Engine 4, 2013), each sample from the level that its solid angle asks for (Krivanek, Colbert: Real-time Shading
// with Filtered Importance Sampling, 2008).
#version 460
#include "common/common.glsl"
#include "cubemap/cubemap_params.h"
layout(local_size_x = 64) in;
PARAMS(MapParams)
BUFFER(readonly, 0, uvec2, mips)
BUFFER(writeonly, 1, uvec2, probes)
#define CUBE_TEXEL(index) unpackTexel(mips[index])
#include "cubemap/cubemap.glsl"
#include "path/shading.glsl"

const uint SAMPLES = 64u;

void main() {
    const uint i = GLOBAL_INDEX, texels = params.size * params.size;
    if (i >= 6u * texels) return;
    const vec3 direction = normalize(cubeTexelDirection(i / texels, uvec2(i % params.size, i % texels / params.size), params.size));
    vec3 t, b;
    tangents(direction, t, b);
    const float alpha = params.roughness * params.roughness;
    const float texel = 4.0 * PI / (6.0 * float(params.source_size) * float(params.source_size));
    vec4 sum = vec4(0);
    float weight = 0.0;
    for (uint k = 0u; k < SAMPLES; k++) {
        const vec3 h = sampleGgx(vec3(0, 0, 1), alpha, vec2((float(k) + 0.5) / float(SAMPLES), float(bitfieldReverse(k)) / 4294967296.0));
        const vec3 l = vec3(2.0 * h.z * h.xy, 2.0 * h.z * h.z - 1.0);
        if (l.z <= 0.0) continue;
        const float solid_angle = 4.0 / (float(SAMPLES) * ggxDistribution(h.z, alpha));
        const float level = clamp(0.5 * log2(solid_angle / texel) + 1.0, 0.0, float(PROBE_LEVELS - 1u));
        const uint near = uint(level + 0.5);
        sum += l.z * cubeLookup(cubeLevelOffset(params.source_size, near), cubeLevelSize(params.source_size, near),
                                t * l.x + b * l.y + direction * l.z);
        weight += l.z;
    }
    probes[params.first + i] = packTexel(sum / weight);
}
