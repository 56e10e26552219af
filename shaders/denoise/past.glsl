// What is kept of a picture for later ones, of each pixel:
//   past.x  normal, packed as in features.glsl
//   past.y  depth; 0: nothing here is to be filtered
//   past.z  object
//   past.w  mean light around, and the standard deviation of that mean (below)
#ifndef PEELRAY_DENOISE_PAST_GLSL
#define PEELRAY_DENOISE_PAST_GLSL

// Times the mean, a deviation that explains any change.
#define NO_LIMIT 1e4

/// A mean and its standard deviation: as halves, the mean's logarithm, since light has no largest value, and the deviation's share of it.
uint packSurroundings(vec2 mean_deviation) {
    const float mean = max(mean_deviation.x, 1e-20);
    return packHalf2x16(vec2(log2(mean), min(mean_deviation.y / mean, NO_LIMIT)));
}

vec2 unpackSurroundings(uint packed) {
    const vec2 halves = unpackHalf2x16(packed);
    const float mean = exp2(halves.x);
    return vec2(mean, halves.y * mean);
}

#endif
