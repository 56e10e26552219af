// Tangents, bent normals and lifted directions.
#version 460
#include "common/common.glsl"
#include "path/shading.glsl"
#include "probe.glsl"
struct Input { vec3 normal, geometric, direction; };
struct Output { vec3 t, b, visible, above; };
PROBE(Input, Output)

Output probe(Input x) {
    Output o;
    tangents(x.normal, o.t, o.b);
    o.visible = visibleNormal(x.normal, x.geometric, x.direction);
    o.above = aboveSurface(x.direction, x.geometric);
    return o;
}
