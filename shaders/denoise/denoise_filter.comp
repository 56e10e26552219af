// One iteration of the edge-avoiding filter (Dammertz et al. 2010; Schied et al. 2017): 5x5 taps of a B3 spline, `step` pixels apart, each
// by how alike its guides and its luminance are. The last one adds to the picture what has changed.
#version 460
#include "common/common.glsl"
#include "denoise/denoise_params.h"
#include "denoise/features.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = 0) const bool last = false;
PARAMS(DenoiseParams)
BUFFER_ALIGNED(readonly, 0, uvec4, features)
BUFFER_ALIGNED(readonly, 1, vec4, signal)
BUFFER_ALIGNED(writeonly, 2, vec4, filtered_signal)
BUFFER_ALIGNED(readonly, 3, vec4, first_signal)
BUFFER(readonly, 4, DenoiseGuide, denoise_guides)
BUFFER_ALIGNED(, 5, vec4, picture)
#include "denoise/tile.glsl"

const float kSpline[3] = float[](0.375, 0.25, 0.0625);  // 6, 4, 1 of 16

/// The variance's mean over the pixels beside this one: its own is too noisy to decide by.
float smoothVariance(ivec2 p) {
    float weights = 0.0, sum = 0.0;
    for (int y = -1; y <= 1; y++)
        for (int x = -1; x <= 1; x++) {
            const ivec2 q = p + ivec2(x, y);
            if (!isInside(q) || !isFiltered(features[pixelIndex(q)])) continue;
            const float weight = (x == 0 ? 0.5 : 0.25) * (y == 0 ? 0.5 : 0.25);
            weights += weight;
            sum += weight * signal[pixelIndex(q)].w;
        }
    return sum / weights;
}

/// Light and variance at a pixel after this iteration.
vec4 filteredAt(ivec2 p, vec4 light) {
    const float variance = smoothVariance(p);
    if (variance <= 0.0) return light;
    const Features pixel = unpackFeatures(features[pixelIndex(p)]);
    const float lit = luminance(light.rgb), per_luminance = 1.0 / (DENOISE_DEVIATIONS * sqrt(variance));
    // As changes, so that light that is the same everywhere stays as it is.
    vec3 change = vec3(0);
    float weights = 0.0, spread = 0.0;
    for (int y = -DENOISE_TAPS; y <= DENOISE_TAPS; y++)
        for (int x = -DENOISE_TAPS; x <= DENOISE_TAPS; x++) {
            const ivec2 offset = ivec2(x, y) * int(params.step), q = p + offset;
            if (!isInside(q)) continue;
            const uvec4 tap = features[pixelIndex(q)];
            if (!isFiltered(tap)) continue;
            const vec4 other = signal[pixelIndex(q)];
            const float unlike = unlikeness(pixel, tap, offset) + abs(luminance(other.rgb) - lit) * per_luminance;
            const float weight = kSpline[abs(x)] * kSpline[abs(y)] * (x == 0 && y == 0 ? 1.0 : exp(-unlike));
            weights += weight;
            change += weight * (other.rgb - light.rgb);
            spread += weight * weight * other.w;
        }
    return vec4(light.rgb + change / weights, spread / (weights * weights));
}

void main() {
    const ivec2 p = tilePixel();
    if (!isInside(p)) return;
    const uint at = pixelIndex(p);
    vec4 light = signal[at];
    const bool filtered_here = isFiltered(features[at]);
    if (filtered_here) light = filteredAt(p, light);
    if (!last) {
        filtered_signal[at] = light;
        return;
    }
    if (!filtered_here) return;
    const vec3 change = (light.rgb - first_signal[at].rgb) * denoise_guides[at].albedo;
    picture[at].rgb = max(picture[at].rgb + change, vec3(0));
}
