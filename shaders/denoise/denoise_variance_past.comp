// The variance of what was added up over several pictures: where these tell it, smoothed; elsewhere that of the present picture by the
// differences of neighbours, over the number of pictures.
#version 460
#include "common/common.glsl"
#include "denoise/denoise_params.h"
#include "denoise/features.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
PARAMS(DenoiseParams)
BUFFER_ALIGNED(readonly, 0, uvec4, features)
BUFFER_ALIGNED(readonly, 1, vec4, signal)
BUFFER_ALIGNED(writeonly, 2, vec4, filtered_signal)
BUFFER_ALIGNED(readonly, 3, vec4, first_signal)
#include "denoise/tile.glsl"
#define LIGHT_OF_ONE first_signal
#include "denoise/variance.glsl"

void main() {
    const ivec2 p = tilePixel();
    if (!isInside(p)) return;
    vec4 light = signal[pixelIndex(p)];
    if (!isFiltered(features[pixelIndex(p)]))
        light.w = 0.0;
    else if (light.w >= 0.0)
        light.w = varianceAt(p, false);
    else
        light.w = varianceAt(p, true) / -light.w;
    filtered_signal[pixelIndex(p)] = light;
}
