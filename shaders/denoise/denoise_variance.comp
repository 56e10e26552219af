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

#define LIGHT_OF_ONE signal
#include "denoise/variance.glsl"

void main() {
    const ivec2 p = tilePixel();
    if (!isInside(p)) return;
    vec4 light = signal[pixelIndex(p)];
    light.w = isFiltered(features[pixelIndex(p)]) ? varianceAt(p, one_sample) : 0.0;
    filtered_signal[pixelIndex(p)] = light;
}
