// What the stages before the fragments hand on: the triangle as the LDI that captures it sees it, the same for all its
// fragments.
#ifndef PEELRAY_LDC_ROUTED_GLSL
#define PEELRAY_LDC_ROUTED_GLSL

#define LDC_ROUTED(direction)                                                          \
    layout(location = 0) flat direction uvec2 routed_id; /* triangle * 4 + axis, body */ \
    layout(location = 1) flat direction vec3 routed_a;                                 \
    layout(location = 2) flat direction vec3 routed_b;                                 \
    layout(location = 3) flat direction vec3 routed_c;                                 \
    layout(location = 4) flat direction vec2 routed_slope;                             \
    layout(location = 5) flat direction vec3 routed_normal; /* unit, in the space of the body */

#define LDC_ROUTED_TRIANGLE LdcTriangle(routed_a, routed_b, routed_c, routed_slope)

#endif
