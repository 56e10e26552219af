// The corners of a triangle, packed (LdcCorners).
#ifndef PEELRAY_LDC_CORNERS_GLSL
#define PEELRAY_LDC_CORNERS_GLSL

#include "ldc/ldc_params.h"

/// From the corners in the body's space.
LdcCorners ldcPackCorners(CubeGrid grid, vec3 a, vec3 b, vec3 c, vec3 normal) {
    a -= grid.origin;
    b -= grid.origin;
    c -= grid.origin;
    return LdcCorners(vec4(a, b.x), vec4(b.yz, c.xy), vec4(c.z, normal));
}

/// From the grid's origin.
void ldcCornersOf(LdcCorners packed, out vec3 a, out vec3 b, out vec3 c) {
    a = packed.a_bx.xyz;
    b = vec3(packed.a_bx.w, packed.byz_cxy.xy);
    c = vec3(packed.byz_cxy.zw, packed.cz_normal.x);
}

vec3 ldcNormalOf(LdcCorners packed) { return packed.cz_normal.yzw; }

#endif
