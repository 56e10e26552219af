// Emitting the fragments of a workgroup: each thread counts its own first, one atomic reserves room for all.
#ifndef PEELRAY_LDC_EMIT_GLSL
#define PEELRAY_LDC_EMIT_GLSL

#include "ldc_common.glsl"

shared uint emit_sums[gl_WorkGroupSize.x];
shared uint emit_base;

/// Where this thread's `count` fragments go; all threads of the workgroup must call.
uint ldcReserve(uint count) {
    const uint lane = gl_LocalInvocationIndex;
    emit_sums[lane] = count;
    barrier();
    for (uint step = 1u; step < gl_WorkGroupSize.x; step <<= 1u) {
        const uint other = lane >= step ? emit_sums[lane - step] : 0u;
        barrier();
        emit_sums[lane] += other;
        barrier();
    }
    if (lane == gl_WorkGroupSize.x - 1u && emit_sums[lane] != 0u) {
        emit_base = atomicAdd(counters[0].fragments, emit_sums[lane]);
        if (emit_base + emit_sums[lane] < emit_base) atomicOr(counters[0].wrapped, LDC_WRAPPED_FRAGMENTS);
    }
    barrier();
    const uint position = emit_base + emit_sums[lane] - count;
    barrier();
    return position;
}

#include "ldc_pixel_emit.glsl"

#endif
