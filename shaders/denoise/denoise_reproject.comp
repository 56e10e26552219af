// One picture further into the past: where each pixel's surface was then, if it was to be seen, and what its light was. The first step
// starts from the present picture; the last one leaves the mean of all that was found, with its variance or, where that is not known, less
// the number of pictures that it is the mean of.
#version 460
#include "common/common.glsl"
#include "denoise/denoise_params.h"
#include "denoise/features.glsl"
#include "denoise/past.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = 0) const bool first = false;
layout(constant_id = 1) const bool last = false;
PARAMS(DenoiseParams)
BUFFER_ALIGNED(readonly, 0, uvec4, features)
BUFFER_ALIGNED(readonly, 1, vec4, signal)
BUFFER_ALIGNED(readonly, 2, uvec4, present)  // the present picture's `past`
BUFFER(readonly, 3, vec3, present_motion)
BUFFER_ALIGNED(readonly, 4, uvec4, past)
BUFFER_ALIGNED(readonly, 5, vec4, past_light)
BUFFER(readonly, 6, vec3, past_motion)
BUFFER(, 7, DenoiseTrail, denoise_trails)
BUFFER_ALIGNED(writeonly, 8, vec4, accumulated)
#include "denoise/tile.glsl"

/// What a picture shows at a place, between its pixels.
struct Found {
    float weights;
    float squares;
    vec3 light;
    float variance;
    vec3 motion;
    vec3 normal;
    vec2 around;  ///< mean light and the deviation of that
};

DenoiseTrail beginning(ivec2 p) {
    const uint at = pixelIndex(p);
    const vec3 motion = present_motion[at];
    const vec4 light = signal[at];
    const float trust = present[at].z == DENOISE_NO_OBJECT ? 0.0 : 1.0;
    return DenoiseTrail(vec2(p) + motion.xy, motion.z, present[at].x, vec3(0), trust, 1.0, 1.0, luminance(light.rgb), 0.0, light.w);
}

/// Does a pixel of the past show the surface of the pixel `at`?
bool isSame(uint at, DenoiseTrail trail, uvec4 seen) {
    if (seen.y == 0u || seen.z != present[at].z) return false;
    const float rise = dot(abs(unpackHalf2x16(features[at].z)), vec2(DENOISE_SAME_RISE)) * trail.depth;
    if (abs(uintBitsToFloat(seen.y) - trail.depth) > DENOISE_SAME_DEPTH * trail.depth + rise) return false;
    return dot(unpackNormal(seen.x), unpackNormal(trail.normal)) >= DENOISE_SAME_NORMAL;
}

Found findAt(uint at, DenoiseTrail trail) {
    Found found = Found(0.0, 0.0, vec3(0), 0.0, vec3(0), vec3(0), vec2(0));
    const vec2 whole = floor(trail.place + 0.5);
    const bvec2 near = lessThan(abs(trail.place - whole), vec2(DENOISE_WHOLE_PIXEL));
    const vec2 place = mix(trail.place, whole, near), corner = floor(place), part = place - corner;
    if (any(lessThan(corner, vec2(-1))) || any(greaterThanEqual(corner, vec2(params.width, params.height)))) return found;
    for (int i = 0; i < 4; i++) {
        const ivec2 step = ivec2(i & 1, i >> 1), q = ivec2(corner) + step;
        const float weight = (step.x == 1 ? part.x : 1.0 - part.x) * (step.y == 1 ? part.y : 1.0 - part.y);
        if (weight <= 0.0 || !isInside(q)) continue;
        const uint there = pixelIndex(q);
        const uvec4 seen = past[there];
        if (!isSame(at, trail, seen)) continue;
        const vec4 light = past_light[there];
        found.weights += weight;
        found.squares += weight * weight;
        found.light += weight * light.rgb;
        found.variance += weight * weight * light.w;
        found.motion += weight * past_motion[there];
        found.normal += weight * unpackNormal(seen.x);
        found.around += weight * unpackSurroundings(seen.w);
    }
    return found;
}

/// How much of what was found is of the present: all of it, unless the light has changed.
float unchanged(uint at, vec2 around) {
    const vec2 now = unpackSurroundings(present[at].w);
    const float least = DENOISE_LEAST_CHANGE * max(now.x, around.x), deviation = sqrt(now.y * now.y + around.y * around.y + least * least);
    const float change = abs(around.x - now.x) / max(deviation, 1e-30);
    return clamp((DENOISE_CHANGE_LAST - change) / (DENOISE_CHANGE_LAST - DENOISE_CHANGE_FIRST), 0.0, 1.0);
}

DenoiseTrail followed(uint at, DenoiseTrail trail) {
    const Found found = findAt(at, trail);
    const float part = found.weights;
    if (part < DENOISE_LEAST_PART) {
        trail.trust = 0.0;
        return trail;
    }
    trail.trust = min(trail.trust, unchanged(at, found.around / part));
    const vec3 light = found.light / part;
    const float trust = trail.trust, from_mean = luminance(light) - trail.mean;
    trail.change += trust * (light - signal[at].rgb);
    trail.weights += trust;
    trail.squares += trust * trust;
    trail.mean += from_mean * trust / trail.weights;
    trail.deviations += trust * from_mean * (luminance(light) - trail.mean);
    if (trail.variance >= 0.0) trail.variance += max(found.variance, 0.0) * trust * trust / (part * part);
    trail.place += found.motion.xy / part;
    trail.depth = found.motion.z / part;
    trail.normal = packNormal(found.normal * inversesqrt(dot(found.normal, found.normal)));
    return trail;
}

/// The variance of the mean, or less how many pictures it is of.
float varianceOf(DenoiseTrail trail) {
    const float weights2 = trail.weights * trail.weights, pictures = weights2 / trail.squares;
    if (trail.variance >= 0.0) return trail.variance / weights2;
    if (pictures < float(DENOISE_LEAST_HISTORY) - 0.5) return -pictures;
    return trail.deviations / (trail.weights - trail.squares / trail.weights) / pictures;
}

void main() {
    const ivec2 p = tilePixel();
    if (!isInside(p)) return;
    const uint at = pixelIndex(p);
    if (!isFiltered(features[at])) {
        if (last) accumulated[at] = signal[at];
        return;
    }
    DenoiseTrail trail;
    if (first)
        trail = beginning(p);
    else
        trail = denoise_trails[at];
    if (trail.trust > 0.0) trail = followed(at, trail);
    if (last)
        accumulated[at] = vec4(signal[at].rgb + trail.change / trail.weights, varianceOf(trail));
    else
        denoise_trails[at] = trail;
}
