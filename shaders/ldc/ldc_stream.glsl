// For the fragment shader of a drawn stream, which may `discard` and else ends in ldcCapture. Bindings 0 to 7 of the stream's stages are
// the library's, its own begin at 8; parameters are LdcParams for all.
#ifndef PEELRAY_LDC_STREAM_GLSL
#define PEELRAY_LDC_STREAM_GLSL

#include "common/common.glsl"
#include "ldc/ldc_params.h"
PARAMS(LdcParams)
BUFFER(, 2, LdcCounters, counters)
BUFFER(readonly, 3, LdcBody, bodies)
BUFFER(writeonly, 5, LdcFragment, fragments)
BUFFER(writeonly, 6, LdcCaptured, captured)
#include "ldc/ldc_bodies.glsl"
#include "ldc/ldc_common.glsl"
#include "ldc/ldc_routed.glsl"
LDC_ROUTED(in)
layout(location = 6) in vec4 routed_data0;
layout(location = 7) in vec4 routed_data1;

/// Appends the sample of this fragment: depth and slopes from the triangle's plane, with a unit normal in the space of the body and a
/// linear colour of [0, 1].
void ldcCapture(vec3 normal, vec4 color) {
    if (gl_SampleMaskIn[0] == 0) return;  // see ldc_abuffer.glsl
    const uint axis = routed_id.x & 3u;
    const uvec3 dims = bodies[routed_id.y].grid.dims;
    const uvec2 pixel = uvec2(gl_FragCoord.xy);
    if (any(greaterThanEqual(vec2(pixel), peelrayToLdi(vec3(dims), axis).xy))) return;
    const uint position = atomicAdd(counters[0].fragments, 1u);
    if (position == 0xffffffffu) atomicOr(counters[0].wrapped, LDC_WRAPPED_FRAGMENTS);
    if (position >= params.fragment_capacity) return;
    float w = ldcDepth(LDC_ROUTED_TRIANGLE, vec2(pixel) + 0.5);
    if (params.by_pixel == 2u) w = ldcRoundDepth(w, float(dims[axis]));
    fragments[position] = LdcFragment(ldcFirstCell(routed_id.y) + ldcPixelOfBody(pixel, axis, dims), routed_id.x, floatBitsToUint(w));
    captured[position] = LdcCaptured(packSnorm2x16(routed_slope / PEELRAY_SLOPE_RANGE), packSnorm4x8(vec4(normal, 0)), packUnorm4x8(color));
}

#endif
