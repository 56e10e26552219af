// Counts the fragments of each pixel of the three LDIs (the paper, section 1.2).
#version 460
#include "ldc/ldc_common.glsl"
#include "ldc/ldc_routed.glsl"
PARAMS(LdcParams)
BUFFER(readonly, 3, LdcBody, bodies)
BUFFER(, 4, uint, layer_counts)
LDC_ROUTED(in)
#include "ldc/ldc_routed_alpha.glsl"

void main() {
    const uint axis = routed_id.x & 3u;
    const uvec2 pixel = uvec2(gl_FragCoord.xy);
    if (any(greaterThanEqual(vec2(pixel), peelrayToLdi(vec3(bodies[routed_id.y].grid.dims), axis).xy)) || !routedPresent(ivec2(pixel))) return;
    atomicAdd(layer_counts[(axis * params.side + pixel.y) * params.side + pixel.x], 1u);
}
