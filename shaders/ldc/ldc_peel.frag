// Depth peeling: rejects what earlier passes captured; the depth test keeps the nearest of the rest, and of equal depths the
// triangle that is drawn first, which has the lowest number. So coplanar fragments come one after another, and none is lost.
#version 460
#include "ldc/ldc_common.glsl"
#include "ldc/ldc_routed.glsl"
PARAMS(LdcParams)
BUFFER(readonly, 3, LdcBody, bodies)
IMAGE(6, texture2DArray, depth_map)  // of the last pass
IMAGE(7, utexture2DArray, id_map)
LDC_ROUTED(in)
#include "ldc/ldc_routed_alpha.glsl"
#include "ldc/ldc_peel.glsl"
layout(location = 0) out vec4 normal_depth;
layout(location = 1) out uvec2 color_id;

void main() {
    const uint axis = routed_id.x & 3u;
    const vec3 dims = peelrayToLdi(vec3(bodies[routed_id.y].grid.dims), axis);
    const ivec2 pixel = ivec2(gl_FragCoord.xy);
    if (any(greaterThanEqual(vec2(pixel), dims.xy)) || !routedPresent(pixel)) discard;
    const LdcTriangle t = LDC_ROUTED_TRIANGLE;
    const float stored = peelStored(ldcDepth(t, vec2(pixel) + 0.5), dims.z), key = peelKey(peelDepth(stored, dims.z));
    if (params.level > 0u) {
        const uint last = texelFetch(id_map, ivec3(pixel, axis), 0).y;
        const float last_key = peelKey(peelDepth(texelFetch(depth_map, ivec3(pixel, axis), 0).w, dims.z));
        if (last == LDC_NOTHING || key < last_key || (key == last_key && routed_id.x <= last)) discard;
    }
    normal_depth = vec4(routed_normal, stored);
    color_id = uvec2(0xffffffffu, routed_id.x);  // no colour is given: white
    gl_FragDepth = key;
}
