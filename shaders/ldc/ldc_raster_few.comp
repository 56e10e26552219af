// Rasterises triangles into the LDIs that capture them, the pixels of a workgroup's small ones by all its threads: where there are too few
// triangles to fill a GPU, the largest of them are what it waits for.
#version 460
#define RASTER_THREADS 256
#include "ldc/ldc_raster.glsl"

/// A small triangle as an LDI sees it, and the pixels of its bounds.
struct SmallTriangle {
    LdcTriangle seen;
    ivec2 first;
    uint width, id, body;
};
shared SmallTriangle small[LDC_TRIANGLES];
shared uint pixels_up_to[LDC_TRIANGLES];  // those of a thread's triangle and of the threads before

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

/// Prefix sums of the threads' pixels; all threads must call.
void sumPixels(uint pixels) {
    const uint lane = gl_LocalInvocationIndex;
    if (lane < LDC_TRIANGLES) pixels_up_to[lane] = pixels;
    barrier();
    for (uint step = 1u; step < LDC_TRIANGLES; step *= 2u) {
        if (lane >= step && lane < LDC_TRIANGLES) pixels += pixels_up_to[lane - step];
        barrier();
        if (lane < LDC_TRIANGLES) pixels_up_to[lane] = pixels;
        barrier();
    }
}

/// Which triangle pixel `i` of the workgroup belongs to.
uint ownerOf(uint i) {
    uint first = 0u;
    for (uint step = LDC_TRIANGLES / 2u; step > 0u; step /= 2u) first += pixels_up_to[first + step - 1u] <= i ? step : 0u;
    return first;
}

/// Fragments in pixel `i` of the workgroup: counted if `write` is false, else written from `position` on. Returns how many.
uint emitPixel(uint i, LdcPlace own, uint own_body, bool write, uint position) {
    const uint owner = ownerOf(i);
    const SmallTriangle s = small[owner];
    const uint j = i - (owner == 0u ? 0u : pixels_up_to[owner - 1u]), row = j / s.width;
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
    sumPixels(pixels);
    const uint all = pixels_up_to[LDC_TRIANGLES - 1u];
    const LdcPlace own = ldcPlaceOf(body);
    uint count = 0u;
    uvec2 covered = uvec2(0);  // rounds of this thread that have fragments: at most small_pixels, which is no more than 64
    for (uint i = gl_LocalInvocationIndex, round = 0u; i < all; i += gl_WorkGroupSize.x, round++) {
        const uint emitted = emitPixel(i, own, body, false, 0u);
        if (emitted != 0u) covered[round >> 5u] |= 1u << (round & 31u);
        count += emitted;
    }
    uint position = ldcReserve(count);
    for (uint i = gl_LocalInvocationIndex, round = 0u; i < all; i += gl_WorkGroupSize.x, round++)
        if ((covered[round >> 5u] >> (round & 31u) & 1u) != 0u) position += emitPixel(i, own, body, true, position);
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
