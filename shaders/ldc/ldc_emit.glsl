// Emitting the fragments of a workgroup: each thread counts its own first, one atomic on the counters reserves room for all.
#ifndef PEELRAY_LDC_EMIT_GLSL
#define PEELRAY_LDC_EMIT_GLSL

#include "ldc/ldc_params.h"

#include "ldc/ldc_common.glsl"

shared uint emit_count;
shared uint emit_base;

/// Where this thread's `count` fragments go; all threads of the workgroup must call. The order within a workgroup is not defined.
uint ldcReserve(uint count) {
    const uint lane = gl_LocalInvocationIndex;
    if (lane == 0u) emit_count = 0u;
    barrier();
    uint position = 0u;
    if (count != 0u) position = atomicAdd(emit_count, count);
    barrier();
    if (lane == 0u && emit_count != 0u) {
        emit_base = atomicAdd(counters[0].fragments, emit_count);
        if (emit_base + emit_count < emit_base) atomicOr(counters[0].wrapped, LDC_WRAPPED_FRAGMENTS);
    }
    barrier();
    return emit_base + position;
}

#include "ldc/ldc_pixel_emit.glsl"

#endif
