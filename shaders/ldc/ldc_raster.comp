// Rasterises triangles into the LDIs that capture them, the pixels of a small one by its own thread.
#version 460
#define RASTER_THREADS 64
#include "ldc/ldc_raster.glsl"

/// Fragments of a small triangle: counted if `write` is false, else written from `position` on.
uint emitSmall(LdcTriangle t, vec3 reach, ivec2 lo, ivec2 hi, uint id, LdcPlace place, bool write, uint position) {
    uint count = 0u;
    for (int y = lo.y; y <= hi.y; y++)
        for (int x = lo.x; x <= hi.x; x++)
            if (ldcCovers(t, reach, vec2(x, y) + 0.5, params.sampling) && (!masked || ldcPresent(place.grid, id, vec2(x, y) + 0.5)))
                count += ldcEmitPixel(t, ivec2(x, y), id, place, write, position + count);
    return count;
}

/// The LDIs that may capture a triangle: only the overlap band has triangles that several of them do.
struct Axes {
    uint first, last;
};

/// Fragments of a triangle where it is small. `covering`: the LDIs, a bit each, in which there are fragments.
uint countSmall(RasterTriangle triangle, Axes axes, LdcPlace place, out uint covering) {
    uint count = covering = 0u;
    for (uint axis = axes.first; axis <= axes.last; axis++) {
        if (!ldcCaptured(triangle.normal, axis, params.sampling)) continue;
        const uint id = triangle.id << 2u | axis;
        const LdcTriangle t = ldcProject(place.grid, triangle.a, triangle.b, triangle.c, triangle.normal, axis);
        ivec2 lo, hi;
        if (!isSmall(t, id, place.grid, lo, hi)) continue;
        const uint emitted = emitSmall(t, ldcReach(t), lo, hi, id, place, false, 0u);
        if (emitted != 0u) covering |= 1u << axis;
        count += emitted;
    }
    return count;
}

void writeSmall(RasterTriangle triangle, Axes axes, LdcPlace place, uint covering, uint position) {
    for (uint axis = axes.first; axis <= axes.last; axis++) {
        if ((covering >> axis & 1u) == 0u) continue;
        const LdcTriangle t = ldcProject(place.grid, triangle.a, triangle.b, triangle.c, triangle.normal, axis);
        ivec2 lo, hi;
        ldcBounds(t, uvec3(peelrayToLdi(vec3(place.grid.dims), axis)).xy, lo, hi);
        position += emitSmall(t, ldcReach(t), lo, hi, triangle.id << 2u | axis, place, true, position);
    }
}

void main() {
    RasterTriangle triangle;
    bool any;
    const bool valid = readTriangles(triangle, any);
    if (!any) return;
    const LdcPlace place = ldcPlaceOf(triangle.body);
    const uint axis = ldcAxis(triangle.normal);
    const Axes axes = params.sampling == LDC_BAND ? Axes(0u, 2u) : Axes(axis, axis);
    uint covering = 0u, count = 0u;
    if (valid) count = countSmall(triangle, axes, place, covering);
    const uint position = ldcReserve(count);
    if (covering != 0u) writeSmall(triangle, axes, place, covering, position);
    cutMany();
}
