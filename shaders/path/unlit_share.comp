// Before post passes change the picture: what unlit colours are of it, which stays right whatever becomes of the picture.
#version 460
#include "common/common.glsl"
#include "path/path_params.h"
layout(local_size_x = 64) in;
PARAMS(uint)
BUFFER(readonly, 0, vec4, picture)
BUFFER(, 1, vec3, unlit)
#include "path/shading.glsl"
#include "path/encode.glsl"

void main() {
    const uint i = GLOBAL_INDEX;
    if (i < params) unlit[i] = unlitShare(unlit[i], picture[i].rgb);
}
