// The variance of the light by what is around. Include after features.glsl, tile.glsl and the buffers features and signal; LIGHT_OF_ONE:
// the buffer of light that has one sample each.
#ifndef PEELRAY_DENOISE_VARIANCE_GLSL
#define PEELRAY_DENOISE_VARIANCE_GLSL

/// A tap's weight and what it says: its variance, or with one sample its luminance.
vec2 tapAt(Features pixel, ivec2 p, ivec2 offset, bool one_sample) {
    const ivec2 q = p + offset;
    if (!isInside(q)) return vec2(0);
    const uvec4 tap = features[pixelIndex(q)];
    if (!isFiltered(tap)) return vec2(0);
    const float variance = signal[pixelIndex(q)].w;
    if (!one_sample && variance < 0.0) return vec2(0);
    return vec2(exp(-unlikeness(pixel, tap, offset)), one_sample ? luminance(LIGHT_OF_ONE[pixelIndex(q)].rgb) : variance);
}

float varianceAt(ivec2 p, bool one_sample) {
    const Features pixel = unpackFeatures(features[pixelIndex(p)]);
    const int reach = DENOISE_VARIANCE_REACH;
    float weights = 0.0, sum = 0.0;
    vec2 above[2 * DENOISE_VARIANCE_REACH + 1];
    for (int x = 0; x <= 2 * reach; x++) above[x] = vec2(0);  // what is not a number stays so, whatever its weight
    for (int y = -reach; y <= reach; y++) {
        vec2 before = vec2(0);
        for (int x = -reach; x <= reach; x++) {
            const vec2 tap = tapAt(pixel, p, ivec2(x, y), one_sample);
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

#endif
