// The variance of the light by what is around: the samples' own, smoothed; with one sample half of the squared differences of neighbours,
// which edges and slopes of the light make larger in few places only.
#version 460
#include "common/common.glsl"
#include "denoise/denoise_params.h"
#include "denoise/features.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = 0) const bool one_sample = false;
PARAMS(DenoiseParams)
BUFFER_ALIGNED(readonly, 0, uvec4, features)
BUFFER_ALIGNED(readonly, 1, vec4, signal)
BUFFER_ALIGNED(writeonly, 2, vec4, filtered_signal)
#include "denoise/tile.glsl"

/// A tap's weight and what it says: its variance, or with one sample its luminance.
vec2 tapAt(Features pixel, ivec2 p, ivec2 offset) {
    const ivec2 q = p + offset;
    if (!isInside(q)) return vec2(0);
    const uvec4 tap = features[pixelIndex(q)];
    if (!isFiltered(tap)) return vec2(0);
    const vec4 light = signal[pixelIndex(q)];
    if (!one_sample && light.w < 0.0) return vec2(0);
    return vec2(exp(-unlikeness(pixel, tap, offset)), one_sample ? luminance(light.rgb) : light.w);
}

float varianceAt(ivec2 p) {
    const Features pixel = unpackFeatures(features[pixelIndex(p)]);
    const int reach = DENOISE_VARIANCE_REACH;
    float weights = 0.0, sum = 0.0;
    vec2 above[2 * DENOISE_VARIANCE_REACH + 1];
    for (int x = 0; x <= 2 * reach; x++) above[x] = vec2(0);  // what is not a number stays so, whatever its weight
    for (int y = -reach; y <= reach; y++) {
        vec2 before = vec2(0);
        for (int x = -reach; x <= reach; x++) {
            const vec2 tap = tapAt(pixel, p, ivec2(x, y));
            if (one_sample) {
                const float beside = before.x * tap.x, below = y > -reach ? above[x + reach].x * tap.x : 0.0;
                weights += beside + below;
                const vec2 distances = tap.y - vec2(before.y, above[x + reach].y);
                sum += beside * distances.x * distances.x + below * distances.y * distances.y;
                before = above[x + reach] = tap;
            } else {
                weights += tap.x;
                sum += tap.x * tap.y;
            }
        }
    }
    if (weights <= 0.0) return 0.0;
    return one_sample ? 0.5 * sum / weights : sum / weights;
}

void main() {
    const ivec2 p = tilePixel();
    if (!isInside(p)) return;
    vec4 light = signal[pixelIndex(p)];
    light.w = isFiltered(features[pixelIndex(p)]) ? varianceAt(p) : 0.0;
    filtered_signal[pixelIndex(p)] = light;
}
