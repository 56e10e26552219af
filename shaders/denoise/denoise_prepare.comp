// The light as it was before the surface took its share of it, with the variance of its mean where samples tell it (else -1); and what the
// pixel shows, packed.
#version 460
#include "common/common.glsl"
#include "denoise/denoise_params.h"
#include "denoise/features.glsl"
layout(local_size_x = 64) in;
PARAMS(DenoiseParams)
BUFFER(readonly, 0, DenoiseGuide, denoise_guides)
BUFFER_ALIGNED(writeonly, 1, uvec4, features)
BUFFER_ALIGNED(writeonly, 2, vec4, signal)

/// The depth at a place, or 0.
float depthAt(ivec2 p) {
    if (any(lessThan(p, ivec2(0))) || any(greaterThanEqual(p, ivec2(params.width, params.height)))) return 0.0;
    const uint at = uint(p.y) * params.width + uint(p.x);
    const float surfaces = denoise_guides[at].surfaces;
    return surfaces > 0.0 ? denoise_guides[at].depth / surfaces : 0.0;
}

/// How the depth rises along an axis: of both sides the flatter one, since the other may be beyond an edge.
float riseAlong(ivec2 p, ivec2 axis, float depth) {
    const float before = depthAt(p - axis), after = depthAt(p + axis);
    const float down = before > 0.0 ? depth - before : 0.0, up = after > 0.0 ? after - depth : 0.0;
    if (before <= 0.0 || after <= 0.0) return before > 0.0 ? down : up;
    return abs(up) < abs(down) ? up : down;
}

void main() {
    const uint i = GLOBAL_INDEX;
    if (i >= params.width * params.height) return;
    const DenoiseGuide guide = denoise_guides[i];
    const float normal2 = dot(guide.normal, guide.normal);
    features[i] = uvec4(0);
    signal[i] = vec4(0, 0, 0, -1);
    if (guide.surfaces == 0.0 || guide.depth <= 0.0 || normal2 == 0.0 || luminance(guide.albedo) <= 0.0) return;
    const ivec2 p = ivec2(i % params.width, i / params.width);
    const float depth = guide.depth / guide.surfaces;
    const vec2 slope = vec2(riseAlong(p, ivec2(1, 0), depth), riseAlong(p, ivec2(0, 1), depth)) / depth;
    const vec2 look = vec2(guide.gloss, luminance(guide.albedo)) / guide.surfaces;
    features[i] = uvec4(packNormal(guide.normal * inversesqrt(normal2)), floatBitsToUint(depth), packHalf2x16(slope), packHalf2x16(look));
    const vec3 light = mix(guide.light / max(guide.albedo, vec3(1e-20)), vec3(0), lessThanEqual(guide.albedo, vec3(0)));
    const float n = guide.surfaces;
    signal[i] = vec4(light, n < 2.0 ? -1.0 : guide.deviations / (n * (n - 1.0)));
}
