// Rasterises triangles into the LDIs that capture them, the pixels of a workgroup's small ones by all its threads: where there are too few
// triangles to fill a GPU, the largest of them are what it waits for.
#version 460
#define RASTER_THREADS 256
#include "ldc/ldc_raster.glsl"
#define LDC_OWNERS LDC_TRIANGLES
#include "ldc/ldc_shared_items.glsl"

/// A small triangle as an LDI sees it, and the pixels of its bounds.
struct SmallTriangle {
    LdcTriangle seen;
    ivec2 first;
    uint width, id, body;
};
shared SmallTriangle small[LDC_TRIANGLES];

/// How many pixels of its LDI the thread's triangle gives the workgroup to go through.
uint placeSmall(RasterTriangle triangle, uint axis) {
    const CubeGrid grid = bodies[triangle.body].grid;
    const uint id = triangle.id << 2u | axis;
    const LdcTriangle t = ldcProject(grid, triangle.a, triangle.b, triangle.c, triangle.normal, axis);
    ivec2 lo, hi;
    if (!isSmall(t, id, grid, lo, hi)) return 0u;
    const uvec2 size = uvec2(hi - lo + 1);
    small[gl_LocalInvocationIndex] = SmallTriangle(t, lo, size.x, id, triangle.body);
    return size.x * size.y;
}

/// Fragments in pixel `i` of the workgroup: counted if `write` is false, else written from `position` on. Returns how many.
uint emitPixel(uint i, LdcPlace own, uint own_body, bool write, uint position) {
    uint j;
    const SmallTriangle s = small[ldcOwnerOf(i, j)];
    const uint row = j / s.width;
    const ivec2 pixel = s.first + ivec2(j - row * s.width, row);
    LdcPlace place = own;
    if (s.body != own_body) place = ldcPlaceOf(s.body);
    if (!write && (!ldcCovers(s.seen, ldcReach(s.seen), vec2(pixel) + 0.5, params.sampling) ||
                   (masked && !ldcPresent(place.grid, s.id, vec2(pixel) + 0.5))))
        return 0u;
    return ldcEmitPixel(s.seen, pixel, s.id, place, write, position);
}

/// The fragments of all pixels that the threads' triangles gave to the workgroup. All threads must call.
void emitSmall(uint pixels, uint body) {
    const uint all = ldcNumberItems(pixels);
    const LdcPlace own = ldcPlaceOf(body);
    uint count = 0u;
    uint covered = 0u;  // rounds of this thread that have fragments: no more than a fourth of small_pixels
    for (uint i = gl_LocalInvocationIndex, round = 0u; i < all; i += gl_WorkGroupSize.x, round++) {
        const uint emitted = emitPixel(i, own, body, false, 0u);
        if (emitted != 0u) covered |= 1u << round;
        count += emitted;
    }
    uint position = ldcReserve(count);
    for (uint i = gl_LocalInvocationIndex, round = 0u; i < all; i += gl_WorkGroupSize.x, round++)
        if ((covered >> round & 1u) != 0u) position += emitPixel(i, own, body, true, position);
}

void main() {
    RasterTriangle triangle;
    bool any;
    const bool valid = readTriangles(triangle, any);
    if (!any) return;
    // Only the overlap band has triangles that several LDIs capture.
    const bool band = params.sampling == LDC_BAND;
    for (uint k = 0u; k < (band ? 3u : 1u); k++) {
        const uint axis = band ? k : ldcAxis(triangle.normal);
        emitSmall(valid && ldcCaptured(triangle.normal, axis, params.sampling) ? placeSmall(triangle, axis) : 0u, triangle.body);
        barrier();
    }
    cutMany();
}
