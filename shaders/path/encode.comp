// Encodes the finished picture, after post passes; without any `accumulate` does.
#version 460
#include "common/common.glsl"
#include "path/path_params.h"
layout(local_size_x = 64) in;
layout(constant_id = 0) const bool has_unlit = false;  // the scene has unlit materials
PARAMS(EncodeParams)
BUFFER(readonly, 0, vec4, picture)
BUFFER(writeonly, 1, uint, encoded)
BUFFER(readonly, 2, vec3, unlit)
#include "path/shading.glsl"
#include "path/encode.glsl"

void main() {
    const uint i = GLOBAL_INDEX;
    if (i >= params.pixels) return;
    const vec4 sum = picture[i];
    vec3 shown = has_unlit ? unlit[i] : vec3(0);
    if (has_unlit && params.shares == 0u) shown = unlitShare(shown, sum.rgb);
    encoded[i] = encode(sum, shown, params.scale, params.share, params.curve, params.straight != 0u);
}
