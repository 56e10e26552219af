// A pixel that is far brighter than all around that shows the same is brought down to what these allow: what is filtered would otherwise
// spread it.
#version 460
#include "common/common.glsl"
#include "denoise/denoise_params.h"
#include "denoise/features.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
PARAMS(DenoiseParams)
BUFFER_ALIGNED(readonly, 0, uvec4, features)
BUFFER_ALIGNED(readonly, 1, vec4, signal)
BUFFER_ALIGNED(writeonly, 2, vec4, filtered_signal)
#include "denoise/tile.glsl"

/// The luminance of a pixel, or what those around it leave of an outlier.
float limitAt(ivec2 p, float lit, float variance) {
    const Features pixel = unpackFeatures(features[pixelIndex(p)]);
    float witnesses = 0.0, sum = 0.0, squares = 0.0;
    for (int y = -DENOISE_OUTLIER_REACH; y <= DENOISE_OUTLIER_REACH; y++)
        for (int x = -DENOISE_OUTLIER_REACH; x <= DENOISE_OUTLIER_REACH; x++) {
            const ivec2 q = p + ivec2(x, y);
            if ((x == 0 && y == 0) || !isInside(q)) continue;
            const uvec4 tap = features[pixelIndex(q)];
            if (!isFiltered(tap) || exp(-unlikeness(pixel, tap, ivec2(x, y))) < DENOISE_SAME) continue;
            const float other = luminance(signal[pixelIndex(q)].rgb);
            witnesses += 1.0;
            sum += other;
            squares += other * other;
        }
    if (witnesses < DENOISE_OUTLIER_WITNESSES) return lit;
    const float mean = sum / witnesses, deviation = sqrt(max(0.0, squares / witnesses - mean * mean));
    const bool steady = variance >= 0.0 && sqrt(variance) < DENOISE_OUTLIER_SHARE * (lit - mean);
    if (steady || lit <= DENOISE_OUTLIER_MEANS * mean + DENOISE_OUTLIER_DEVIATIONS * deviation) return lit;
    return mean + DENOISE_OUTLIER_LEFT * deviation;
}

void main() {
    const ivec2 p = tilePixel();
    if (!isInside(p)) return;
    vec4 light = signal[pixelIndex(p)];
    const float lit = luminance(light.rgb);
    if (isFiltered(features[pixelIndex(p)]) && lit > 0.0) {
        const float limit = limitAt(p, lit, light.w);
        if (lit > limit) {
            const float kept = limit / lit;
            light.rgb *= kept;
            if (light.w > 0.0) light.w *= kept * kept;
        }
    }
    filtered_signal[pixelIndex(p)] = light;
}
