// The a-buffer on devices whose fragment shaders have no subgroup operations: one atomic each.
#version 460
#include "common/common.glsl"
#include "ldc/ldc_params.h"
PARAMS(LdcParams)
BUFFER(, 2, LdcCounters, counters)
BUFFER(readonly, 3, LdcBody, bodies)
BUFFER(, 4, uint, node_masks)
BUFFER(writeonly, 5, LdcFragment, fragments)
#include "ldc/ldc_pixel_emit.glsl"
#include "ldc/ldc_routed.glsl"
LDC_ROUTED(in)
#include "ldc/ldc_routed_alpha.glsl"

uint reserve(uint count) {
    const uint base = atomicAdd(counters[0].fragments, count);
    if (base + count < base) atomicOr(counters[0].wrapped, LDC_WRAPPED_FRAGMENTS);
    return base;
}
#include "ldc/ldc_abuffer.glsl"
