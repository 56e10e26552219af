// The next coarser level of a cube map: the mean of four lookups around each texel, across faces where need be.
#version 460
#include "common/common.glsl"
#include "cubemap/cubemap_params.h"
layout(local_size_x = 64) in;
PARAMS(MapParams)
BUFFER(, 0, uvec2, mips)
#define CUBE_TEXEL(index) unpackTexel(mips[index])
#include "cubemap/cubemap.glsl"

void main() {
    const uint i = GLOBAL_INDEX, texels = params.size * params.size;
    if (i >= 6u * texels) return;
    const uint face = i / texels;
    const vec2 step = vec2(0.5 / float(params.size - 1u));  // a quarter of a texel, of 2 / (size - 1)
    const vec2 p = vec2(i % params.size, i % texels / params.size) * (2.0 / float(params.size - 1u)) - 1.0;
    vec4 sum = vec4(0);
    for (int k = 0; k < 4; k++) {
        const vec2 q = p + step * vec2((k & 1) != 0 ? 1 : -1, (k & 2) != 0 ? 1 : -1);
        sum += cubeLookup(params.source_first, params.source_size, cubeDirection(face, vec2(q.x, -q.y)));
    }
    mips[params.first + i] = packTexel(0.25 * sum);
}
