// A projected triangle at one pixel: coverage, depth range, packed sample.
#version 460
#include "ldc/ldc_common.glsl"
#include "probe.glsl"
struct Input { vec3 a, b, c; vec2 slope; ivec2 pixel; uint voxel_w, planar; };
struct Output { vec3 edges; uint covers; ivec2 depth; uvec4 packed; uint touches; };
PROBE(Input, Output)

Output probe(Input x) {
    const LdcTriangle t = LdcTriangle(x.a, x.b, x.c, x.slope);
    const vec2 centre = vec2(x.pixel) + 0.5;
    const uint sampling = x.planar != 0u ? LDC_BAND : LDC_CONSERVATIVE;
    Output o;
    o.edges = ldcEdges(t, centre);
    o.covers = ldcCovers(t, ldcReach(t), centre, sampling) ? 1u : 0u;
    o.depth = ldcDepthRange(t, centre, sampling, 0.0);
    // In the z-LDI (u, v, w) is (x, y, z).
    const uvec3 voxel = uvec3(x.pixel, x.voxel_w);
    o.packed = x.planar != 0u ? uvec4(ldcPackSample(t, voxel, 2u, LDC_BAND, true), 0, 0)
                              : ldcPackPatch(t, voxel, 7u << 2u | 2u, 1.0, PEELRAY_MARGIN, true);
    o.touches = ldcTouches(t, vec3(voxel) + 0.5) ? 1u : 0u;
    return o;
}
