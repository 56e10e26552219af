// The bounds of bodies, grown by the vertices that a workgroup of 64 threads makes. Include after the buffers body_lower and
// body_upper.
#ifndef PEELRAY_GROW_BOUNDS_GLSL
#define PEELRAY_GROW_BOUNDS_GLSL

#include "common/bounds.glsl"

shared uvec3 lowers[64], uppers[64];

/// All threads of the workgroup must call, with the same body; what is not `valid` or not finite bounds nothing.
void growBounds(uint body, vec3 position, bool valid) {
    const uint lane = gl_LocalInvocationIndex;
    uvec3 lower = uvec3(0xffffffffu), upper = uvec3(0u);
    if (valid && isBounded(position)) lower = upper = orderedBits(position);
    lowers[lane] = lower;
    uppers[lane] = upper;
    for (uint step = 32u; step > 0u; step >>= 1u) {
        barrier();
        if (lane < step) {
            lowers[lane] = min(lowers[lane], lowers[lane + step]);
            uppers[lane] = max(uppers[lane], uppers[lane + step]);
        }
    }
    barrier();
    // Most of a large body's workgroups are inside what others have found.
    if (lane < 3u) {
        if (lowers[0][lane] < body_lower[body][lane]) atomicMin(body_lower[body][lane], lowers[0][lane]);
        if (uppers[0][lane] > body_upper[body][lane]) atomicMax(body_upper[body][lane], uppers[0][lane]);
    }
}

#endif
