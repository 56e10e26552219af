// Encodes the finished picture, after post passes; without any `accumulate` does.
#version 460
#include "common/common.glsl"
#include "path/path_params.h"
layout(local_size_x = 64) in;
PARAMS(EncodeParams)
BUFFER(readonly, 0, vec4, picture)
BUFFER(writeonly, 1, uint, encoded)
#include "path/shading.glsl"
#include "path/encode.glsl"

void main() {
    const uint i = GLOBAL_INDEX;
    if (i < params.pixels) encoded[i] = encode(picture[i].rgb, params.scale, params.curve);
}
