// The a-buffer: every fragment appends itself to the list of all; one atomic reserves room for a subgroup.
#version 460
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_arithmetic : require
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
    const uint all = subgroupAdd(count), before = subgroupExclusiveAdd(count);
    uint base = 0u;
    if (subgroupElect()) {
        base = atomicAdd(counters[0].fragments, all);
        if (base + all < base) atomicOr(counters[0].wrapped, LDC_WRAPPED_FRAGMENTS);
    }
    return subgroupBroadcastFirst(base) + before;
}
#include "ldc/ldc_abuffer.glsl"
