// What later pictures are to know of this one: what each pixel shows, its light, the mean light of what shows the same around it, and
// where it was before.
#version 460
#include "common/common.glsl"
#include "denoise/denoise_params.h"
#include "denoise/features.glsl"
#include "denoise/past.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
PARAMS(DenoiseParams)
BUFFER_ALIGNED(readonly, 0, uvec4, features)
BUFFER_ALIGNED(readonly, 1, vec4, signal)
BUFFER(readonly, 2, DenoiseMotion, denoise_motions)
BUFFER_ALIGNED(writeonly, 3, uvec4, past)
BUFFER_ALIGNED(writeonly, 4, vec4, past_light)
BUFFER(writeonly, 5, vec3, past_motion)
#include "denoise/tile.glsl"

/// The mean luminance around a pixel, and the standard deviation of that mean: of too few pixels nothing is known, and it has no limit.
vec2 surroundings(ivec2 p) {
    const Features pixel = unpackFeatures(features[pixelIndex(p)]);
    const int reach = DENOISE_VARIANCE_REACH;
    float weights = 0.0, squares = 0.0, mean = 0.0, deviations = 0.0;
    for (int y = -reach; y <= reach; y++)
        for (int x = -reach; x <= reach; x++) {
            const ivec2 q = p + ivec2(x, y);
            if (!isInside(q) || !isFiltered(features[pixelIndex(q)])) continue;
            const float weight = exp(-unlikeness(pixel, features[pixelIndex(q)], ivec2(x, y)));
            if (weight <= 0.0) continue;
            weights += weight;
            squares += weight * weight;
            const float from_mean = luminance(signal[pixelIndex(q)].rgb) - mean;
            mean += from_mean * weight / weights;
            deviations += weight * from_mean * (luminance(signal[pixelIndex(q)].rgb) - mean);
        }
    if (weights * weights < float(DENOISE_OUTLIER_WITNESSES) * squares) return vec2(mean, mean * NO_LIMIT);
    return vec2(mean, sqrt(max(deviations, 0.0) * squares / (weights - squares / weights)) / weights);
}

void main() {
    const ivec2 p = tilePixel();
    if (!isInside(p)) return;
    const uint at = pixelIndex(p);
    const DenoiseMotion way = denoise_motions[at];
    uvec4 record = uvec4(0);
    if (isFiltered(features[at])) record = uvec4(features[at].xy, way.object, packSurroundings(surroundings(p)));
    past[at] = record;
    past_light[at] = signal[at];
    past_motion[at] = vec3(way.motion, way.depth);
}
