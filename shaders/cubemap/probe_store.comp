// A rendered face becomes a face of a probe: radiance where there is geometry; the environment is added at the lookup, sharp.
#version 460
#include "common/common.glsl"
#include "common/ray.h"
#include "cubemap/cubemap_params.h"
#include "path/frame.h"
#include "path/path_params.h"
layout(local_size_x = 64) in;
PARAMS(MapParams)
BUFFER(readonly, 0, Frame, frame)
BUFFER(readonly, 1, PathNode, nodes)
BUFFER(readonly, 2, Hit, hits)
BUFFER(, 3, uvec2, probes)
#include "cubemap/cubemap.glsl"
#include "view/camera.glsl"

void main() {
    const uint i = GLOBAL_INDEX;
    if (i >= frame[0].row_pixels * ((params.size + 7u) / 8u * 8u)) return;
    const uvec2 pixel = recordPixel(i, 0u);
    if (pixel.x >= params.size || pixel.y >= params.size) return;
    const vec3 radiance = nodes[i].radiance;
    const bool finite = radiance.r < 1e30 && radiance.g < 1e30 && radiance.b < 1e30 && radiance.r >= 0.0 && radiance.g >= 0.0 && radiance.b >= 0.0;
    const bool covered = hits[i].triangle != NO_TRIANGLE;
    vec4 texel = covered ? vec4(finite ? radiance : vec3(0), 1) : vec4(0);
    const uint at = params.first + pixel.y * params.size + pixel.x;
    if (params.sample_index > 0u) {
        const vec4 before = unpackTexel(probes[at]);
        texel = before + (min(texel, vec4(65504.0)) - before) / float(params.sample_index + 1u);
    }
    probes[at] = packTexel(texel);
}
