// peelrayIntersect, peelrayIntersectPrecise.
#version 460
#include "common/common.glsl"
#include "peelray/intersect.glsl"
#include "probe.glsl"
struct Input { vec3 origin, direction, a, b, c; };
struct Output { uint fast; float fast_t; vec2 fast_uv; uint hit; float t; vec2 uv; };
PROBE(Input, Output)

Output probe(Input x) {
    Output o;
    o.fast = peelrayIntersect(x.origin, x.direction, x.a, x.b, x.c, o.fast_t, o.fast_uv);
    o.hit = peelrayIntersectPrecise(x.origin, vec3(0), x.direction, x.a, x.b, x.c, o.t, o.uv) ? 1u : 0u;
    return o;
}
