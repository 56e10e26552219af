// Fragments append themselves: what ldc_abuffer.frag and ldc_abuffer_plain.frag share. Include after reserve().
#include "ldc/ldc_params.h"
void main() {
    // Helper invocations, which cover nothing, must reserve nothing. (Not by gl_HelperInvocation: Mesa's lavapipe 22.3 lacks it.)
    if (gl_SampleMaskIn[0] == 0) return;
    const LdcPlace place = ldcPlaceOf(routed_id.y);
    const LdcTriangle t = LDC_ROUTED_TRIANGLE;
    const ivec2 pixel = ivec2(gl_FragCoord.xy);
    ivec2 lo = ivec2(0), hi = ivec2(peelrayToLdi(vec3(place.grid.dims), routed_id.x & 3u).xy) - 1;
    // Conservative: the device, or the dilation, offers more pixels than are touched.
    if (params.sampling == LDC_CONSERVATIVE && !(ldcBounds(t, uvec2(hi) + 1u, lo, hi) && ldcCovers(t, ldcReach(t), vec2(pixel) + 0.5, LDC_CONSERVATIVE)))
        return;
    if (any(lessThan(pixel, lo)) || any(greaterThan(pixel, hi)) || !routedPresent(pixel)) return;
    const uint position = reserve(ldcEmitPixel(t, pixel, routed_id.x, place, false, 0u));
    ldcEmitPixel(t, pixel, routed_id.x, place, true, position);
}
