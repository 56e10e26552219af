// How densely directions to the environment are drawn (src/scene/light_distribution.h). Include after frame.glsl.
#ifndef PEELRAY_ENVIRONMENT_DENSITY_GLSL
#define PEELRAY_ENVIRONMENT_DENSITY_GLSL

#include "path/random.glsl"

/// Chooses between two parts by a random number, which it renews. False: the first.
bool chooseSecond(inout float u, float first, float second) {
    const float sum = first + second, at = u * sum;
    const bool is_second = at >= first;
    u = clamp(is_second ? (at - first) / second : at / first, 0.0, 0.99999994);
    return is_second;
}

uint firstQuad(uint level) { return frame[0].env_quads + 1u + 2u * ((1u << 2u * (level - 1u)) - 1u) / 3u; }

/// Every second bit.
uint gatherBits(uint v) {
    v &= 0x55555555u;
    v = (v | v >> 1) & 0x33333333u;
    v = (v | v >> 2) & 0x0f0f0f0fu;
    v = (v | v >> 4) & 0x00ff00ffu;
    return (v | v >> 8) & 0x0000ffffu;
}

/// A direction by the environment's brightness; `random` in [0, 1).
vec3 environmentDirection(vec2 random) {
    const vec4 halves = lookups[frame[0].env_quads];
    uint code = chooseSecond(random.x, halves.x, halves.y) ? 1u : 0u;
    [[dont_unroll]] for (uint level = 1u; level <= frame[0].env_depth; level++) {
        const vec4 quad = lookups[firstQuad(level) + code];
        const bool right = chooseSecond(random.x, quad.x + quad.z, quad.y + quad.w);
        const bool lower = right ? chooseSecond(random.y, quad.y, quad.w) : chooseSecond(random.y, quad.x, quad.z);
        code = code << 2 | (lower ? 2u : 0u) | (right ? 1u : 0u);
    }
    const uint depth = frame[0].env_depth, half_width = 1u << depth, cell = code & ((1u << 2u * depth) - 1u);
    const float rows = float(half_width), column = float((code >> 2u * depth) * half_width + gatherBits(cell)) + random.x;
    const float row = float(gatherBits(cell >> 1u));
    const float top = cos(PI * row / rows), bottom = cos(PI * (row + 1.0) / rows), y = mix(top, bottom, random.y);
    const float azimuth = (column / rows - 1.0) * PI, flat_part = sqrt(max(0.0, 1.0 - y * y));
    return vec3(flat_part * sin(azimuth), y, -flat_part * cos(azimuth));
}

/// Of environmentDirection(), per steradian.
float environmentDensity(vec3 d) {
    const uint depth = frame[0].env_depth, half_width = 1u << depth;
    const float rows = float(half_width);
    const uvec2 cell = min(uvec2(equirectangular(d) * vec2(2.0 * rows, rows)), uvec2(2u * half_width - 1u, half_width - 1u));
    const uint column = cell.x, row = cell.y;
    const uint half_code = column >> depth, code = half_code << 2u * depth | spreadBits(column - half_code * half_width) | spreadBits(row) << 1;
    const float solid_angle = PI / rows * (cos(PI * float(row) / rows) - cos(PI * float(row + 1u) / rows));
    return lookups[firstQuad(depth) + (code >> 2)][code & 3u] / solid_angle;
}

#endif
