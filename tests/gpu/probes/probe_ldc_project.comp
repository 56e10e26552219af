// A triangle in an LDI: normal, axis, capture, corners, slopes, bounds.
#version 460
#include "ldc/ldc_common.glsl"
#include "probe.glsl"
struct Input { CubeGrid grid; vec3 a, b, c; uint axis, planar; };
struct Output { vec3 normal; uint axis, captured, inside; vec3 a, b, c; vec2 slope; ivec2 lo, hi; };
PROBE(Input, Output)

Output probe(Input x) {
    Output o;
    o.normal = ldcNormal(x.a, x.b, x.c, x.grid.inv_voxel);
    o.axis = ldcAxis(o.normal);
    o.captured = ldcCaptured(o.normal, x.axis, x.planar != 0u ? LDC_BAND : LDC_CONSERVATIVE) ? 1u : 0u;
    const LdcTriangle t = ldcProject(x.grid, x.a, x.b, x.c, o.normal, x.axis);
    o.a = t.a;
    o.b = t.b;
    o.c = t.c;
    o.slope = t.slope;
    const uvec3 dims = uvec3(peelrayToLdi(vec3(x.grid.dims), x.axis));
    o.inside = ldcBounds(t, dims.xy, o.lo, o.hi) ? 1u : 0u;
    return o;
}
