// What the passes that build the cube share: a triangle as one LDI sees it, the packing of keys, masks of 4x4x4 cells.
#ifndef PEELRAY_LDC_COMMON_GLSL
#define PEELRAY_LDC_COMMON_GLSL

#include "common/common.glsl"
#include "ldc/ldc_params.h"
#include "peelray/peelray_sample.glsl"
#include "peelray/precise.glsl"

// Filed this far beyond its own extent, in voxels, so that rounding (coordinates up to 2048) never loses a sample; half of
// the traversal's slack.
const float LDC_SLACK = 1e-3;
// Large triangles are cut into blocks of so many pixels per side.
const uint LDC_BLOCK = 32;
// The overlap band: a triangle also goes into a second LDI if its normal's component there is at least
// this share of the largest. Without it 2-4 % of planar hits leak, with it 0.1-0.3 %.
const float LDC_OVERLAP = 0.8;
// By pixel lists longer than this are sorted by a workgroup of their own.
const uint LDC_LONG_LIST = 256;

/// A triangle in one LDI: corners (u, v, w) in voxel units, counter-clockwise in (u, v), and the slopes of its plane.
struct LdcTriangle {
    vec3 a, b, c;
    vec2 slope;
};

uvec3 ldcFromLdi(uvec3 p, uint axis) { return axis == 0u ? p.zxy : (axis == 1u ? p.yzx : p); }

/// a*b - c*d with one rounding's error, so that the normals of needles keep their direction.
float ldcDifference(float a, float b, float c, float d) {
    const vec2 r = peelrayAdd(peelrayTwoProduct(a, b), -peelrayTwoProduct(c, d));
    return r.x + r.y;
}

vec3 ldcNormal(vec3 a, vec3 b, vec3 c, float inv_voxel) {
    const vec3 e = (b - a) * inv_voxel, f = (c - a) * inv_voxel;
    return vec3(ldcDifference(e.y, f.z, e.z, f.y), ldcDifference(e.z, f.x, e.x, f.z), ldcDifference(e.x, f.y, e.y, f.x));
}

/// The LDI axis of a normal: its largest component (the first of equals).
uint ldcAxis(vec3 n) {
    const vec3 m = abs(n);
    return m.x >= m.y && m.x >= m.z ? 0u : (m.y >= m.z ? 1u : 2u);
}

/// Is a triangle with normal `n` captured by the LDI of `axis`?
bool ldcCaptured(vec3 n, uint axis, uint sampling) {
    if (axis == ldcAxis(n)) return true;
    const vec3 m = abs(n);
    return sampling == LDC_BAND && m[axis] >= LDC_OVERLAP * max(m.x, max(m.y, m.z));
}

/// `a`, `b`, `c`: from the grid's origin, in the units of the body's space.
LdcTriangle ldcProjectFrom(float inv_voxel, vec3 a, vec3 b, vec3 c, vec3 normal, uint axis) {
    LdcTriangle t;
    t.a = peelrayToLdi(a * inv_voxel, axis);
    t.b = peelrayToLdi(b * inv_voxel, axis);
    t.c = peelrayToLdi(c * inv_voxel, axis);
    const vec3 n = peelrayToLdi(normal, axis);
    t.slope = clamp(-n.xy / n.z, vec2(-PEELRAY_SLOPE_RANGE), vec2(PEELRAY_SLOPE_RANGE));
    if (n.z < 0.0) {
        const vec3 swapped = t.b;
        t.b = t.c;
        t.c = swapped;
    }
    return t;
}
LdcTriangle ldcProject(CubeGrid grid, vec3 a, vec3 b, vec3 c, vec3 normal, uint axis) {
    return ldcProjectFrom(grid.inv_voxel, a - grid.origin, b - grid.origin, c - grid.origin, normal, axis);
}

/// Pixels [lo, hi] whose square the triangle's bounding rectangle touches; false: none inside the LDI.
bool ldcBounds(LdcTriangle t, uvec2 dims, out ivec2 lo, out ivec2 hi) {
    lo = max(ivec2(0), ivec2(floor(min(t.a.xy, min(t.b.xy, t.c.xy)) - LDC_SLACK)));
    hi = min(ivec2(dims) - 1, ivec2(floor(max(t.a.xy, max(t.b.xy, t.c.xy)) + LDC_SLACK)));
    return lo.x <= hi.x && lo.y <= hi.y;
}

/// Edge functions at a point: positive inside, in units of (edge length * distance).
vec3 ldcEdges(LdcTriangle t, vec2 p) {
    const vec2 e0 = t.b.xy - t.a.xy, e1 = t.c.xy - t.b.xy, e2 = t.a.xy - t.c.xy;
    return vec3(e0.x * (p.y - t.a.y) - e0.y * (p.x - t.a.x), e1.x * (p.y - t.b.y) - e1.y * (p.x - t.b.x),
                e2.x * (p.y - t.c.y) - e2.y * (p.x - t.c.x));
}

/// |ex| + |ey| of each edge: a square of half-width h touches the half-plane where edge >= -h * this.
vec3 ldcReach(LdcTriangle t) {
    const vec2 e0 = abs(t.b.xy - t.a.xy), e1 = abs(t.c.xy - t.b.xy), e2 = abs(t.a.xy - t.c.xy);
    return vec3(e0.x + e0.y, e1.x + e1.y, e2.x + e2.y);
}

/// Does the triangle have a sample in this pixel? Conservative: it touches the pixel's square; else it covers the pixel's
/// centre.
bool ldcCovers(LdcTriangle t, vec3 reach, vec2 centre, uint sampling) {
    const float h = sampling == LDC_CONSERVATIVE ? 0.5 + LDC_SLACK : LDC_SLACK;
    return all(greaterThanEqual(ldcEdges(t, centre), -h * reach));
}

/// The plane's depth at the pixel's centre.
float ldcDepth(LdcTriangle t, vec2 centre) { return t.a.z + dot(t.slope, centre - t.a.xy); }

/// Voxels [lo, hi] of the pixel's column that the sample's patch touches, before clamping to the LDI's depth. `tolerance`: in
/// voxels, of LDC_CENTRE, whose patch is as high as that.
ivec2 ldcDepthRange(LdcTriangle t, vec2 centre, uint sampling, float tolerance) {
    const float w = ldcDepth(t, centre);
    const float half_width = sampling == LDC_CONSERVATIVE ? 0.5 : PEELRAY_FOOTPRINT;
    const float extent = sampling == LDC_CENTRE ? tolerance : half_width * (abs(t.slope.x) + abs(t.slope.y));
    vec2 range = vec2(w - extent, w + extent);
    if (sampling == LDC_CONSERVATIVE)
        range = vec2(max(range.x, min(t.a.z, min(t.b.z, t.c.z))), min(range.y, max(t.a.z, max(t.b.z, t.c.z))));
    return ivec2(floor(range + vec2(-2.0 * LDC_SLACK, 2.0 * LDC_SLACK)));
}

/// Does a triangle that covers a voxel's pixel, and has the voxel in its depth range, touch the voxel? Conservative: what is left of the
/// separating axes of triangle and box (Akenine-Möller, JGT 2001), those of the edges as they are seen along u and along v.
bool ldcTouches(LdcTriangle t, vec3 centre) {
    const float h = 0.5 + 2.0 * LDC_SLACK;
    const vec3 e0 = t.b - t.a, e1 = t.c - t.b, e2 = t.a - t.c, to_a = centre - t.a, to_b = centre - t.b, to_c = centre - t.c;
    // How far the voxel's centre is beside each edge, and the third corner: on whose side the triangle is decide these corners themselves,
    // not the normal, for edges may be as short as the rounding of their ends.
    precise vec3 u = vec3(e0.y * to_a.z - e0.z * to_a.y, e1.y * to_b.z - e1.z * to_b.y, e2.y * to_c.z - e2.z * to_c.y);
    precise vec3 v = vec3(e0.z * to_a.x - e0.x * to_a.z, e1.z * to_b.x - e1.x * to_b.z, e2.z * to_c.x - e2.x * to_c.z);
    precise vec3 corner_u = vec3(e0.z * e2.y - e0.y * e2.z, e1.z * e0.y - e1.y * e0.z, e2.z * e1.y - e2.y * e1.z);
    precise vec3 corner_v = vec3(e0.x * e2.z - e0.z * e2.x, e1.x * e0.z - e1.z * e0.x, e2.x * e1.z - e2.z * e1.x);
    const vec3 x = abs(vec3(e0.x, e1.x, e2.x)), y = abs(vec3(e0.y, e1.y, e2.y)), z = abs(vec3(e0.z, e1.z, e2.z));
    const vec3 reach_u = h * (y + z), reach_v = h * (z + x);
    // Written so that a NaN passes.
    return !(any(lessThan(u, min(corner_u, 0.0) - reach_u)) || any(greaterThan(u, max(corner_u, 0.0) + reach_u)) ||
             any(lessThan(v, min(corner_v, 0.0) - reach_v)) || any(greaterThan(v, max(corner_v, 0.0) + reach_v)));
}

/// Do the tables hold all cells, or pixels? Otherwise nothing is written to them, and all is redone.
#define LDC_CELLS_FIT(counts) (counts.cells <= params.cell_capacity)
/// Did the stages before the samples fit? Otherwise they are all redone.
#define LDC_FITS(counts) \
    (LDC_CELLS_FIT(counts) && counts.occupied <= params.occupied_capacity && counts.nodes <= params.node_capacity)

// --- Keys ---

uint ldcTopIndex(uvec3 voxel, uvec3 dims) {
    const uvec3 top = voxel >> 4u, tops = dims >> 4u;
    return (top.z * tops.y + top.y) * tops.x + top.x;
}
uvec3 ldcTopCell(uint index, uvec3 dims) {
    const uvec3 tops = dims >> 4u;
    return uvec3(index % tops.x, (index / tops.x) % tops.y, index / (tops.x * tops.y));
}
uint ldcNodeInTop(uvec3 voxel) { return peelrayIn64(voxel >> 2u); }
uint ldcVoxelInNode(uvec3 voxel) { return peelrayIn64(voxel); }
/// A pixel of a body's three LDIs, which lie one behind the other.
uint ldcPixelOfBody(uvec2 pixel, uint axis, uvec3 dims) {
    const uint before = axis == 0u ? 0u : dims.y * dims.z + (axis == 1u ? 0u : dims.z * dims.x);
    return before + peelrayPixelIndex(pixel, uint(peelrayToLdi(vec3(dims), axis).x));
}
/// What a half float holds of a number in [0, 1], rounded to nearest even. In integers: compilers remove a packing that
/// is followed by an unpacking.
float ldcHalf(float x) {
    if (x < 6.103515625e-5) return roundEven(x * 16777216.0) / 16777216.0;  // subnormal
    const uint bits = floatBitsToUint(x);
    return uintBitsToFloat((bits + 0xfffu + (bits >> 13u & 1u)) & ~0x1fffu);
}
/// A depth as a half float of [0, 1] holds it, over an LDI of so many voxels: the paper's 16-bit depth.
float ldcRoundDepth(float w, float voxels) { return ldcHalf(w / voxels) * voxels; }
uvec3 ldcCell64(uint index) { return uvec3(index & 3u, (index >> 2u) & 3u, index >> 4u); }

// --- 4x4x4 occupancy masks: bit z*16 + y*4 + x of (low word, high word) ---

bool ldcMaskBit(uvec2 mask, uint bit) { return ((bit < 32u ? mask.x : mask.y) >> (bit & 31u) & 1u) != 0u; }
uint ldcMaskCount(uvec2 mask) { return uint(bitCount(mask.x) + bitCount(mask.y)); }
/// Set bits below `bit`.
uint ldcMaskRank(uvec2 mask, uint bit) {
    const uint low = bit < 32u ? mask.x & ((1u << bit) - 1u) : mask.x;
    const uint high = bit < 32u ? 0u : mask.y & ((1u << (bit - 32u)) - 1u);
    return uint(bitCount(low) + bitCount(high));
}
uvec2 ldcMaskUp(uvec2 mask, uint bits) { return uvec2(mask.x << bits, mask.y << bits | mask.x >> (32u - bits)); }
uvec2 ldcMaskDown(uvec2 mask, uint bits) { return uvec2(mask.x >> bits | mask.y << (32u - bits), mask.y >> bits); }

/// Extends the empty box `box` by its neighbours `slab`, if it does not end at the border `rim` and they are empty.
void ldcGrowFace(inout uvec2 box, uvec2 slab, uvec2 rim, uvec2 mask) {
    const uvec2 blocked = (box & rim) | (slab & mask);
    if ((blocked.x | blocked.y) == 0u) box |= slab;
}

/// The largest empty box around the empty cell `index` that greedy growth finds, face by face, inside the 4x4x4 cells.
/// Packed as the traversal reads it: lo 3x2 bits, hi 3x2 bits, which are the indices of the box's first and last cell.
uint ldcGrowBox(uvec2 mask, uint index) {
    uvec2 box = index < 32u ? uvec2(1u << index, 0u) : uvec2(0u, 1u << (index - 32u));
    for (int round = 0; round < 3; round++) {
        // A box moved by one cell is the box and its next slab: what it adds must be free.
        ldcGrowFace(box, ldcMaskDown(box, 1u), uvec2(0x11111111u), mask);
        ldcGrowFace(box, ldcMaskUp(box, 1u), uvec2(0x88888888u), mask);
        ldcGrowFace(box, ldcMaskDown(box, 4u), uvec2(0x000f000fu), mask);
        ldcGrowFace(box, ldcMaskUp(box, 4u), uvec2(0xf000f000u), mask);
        ldcGrowFace(box, ldcMaskDown(box, 16u), uvec2(0x0000ffffu, 0u), mask);
        ldcGrowFace(box, ldcMaskUp(box, 16u), uvec2(0u, 0xffff0000u), mask);
    }
    const uint first = box.x != 0u ? uint(findLSB(box.x)) : 32u + uint(findLSB(box.y));
    const uint last = box.y != 0u ? 32u + uint(findMSB(box.y)) : uint(findMSB(box.x));
    return first | last << 6u;
}

/// The plane's depth at the centre of the voxel's pixel, from the voxel's corner.
float ldcDepthIn(LdcTriangle t, vec3 corner) { return ldcDepth(t, corner.xy + 0.5) - corner.z; }

/// The normal (-slope, 1) of the plane along x, y, z as half floats: only the axis's own is 1.
uvec3 ldcHalfNormal(vec2 slope, uint axis) {
    // Rounded to nearest first: how packHalf2x16 rounds is left to the device.
    uvec2 bits = floatBitsToUint(-slope);
    bits = (bits + 0xfffu + (bits >> 13u & 1u)) & ~0x1fffu;
    const uint ONE = 0x3c00u, uv = packHalf2x16(uintBitsToFloat(bits));
    uvec2 halves = uvec2(uv & 0xffffu, uv >> 16u);
    // The nearer one of its neighbours, 1 - 2^-11 and 1 + 2^-10.
    if (halves.x == ONE) halves.x = -slope.x > 1.0 + 1.0 / 4096.0 ? ONE + 1u : ONE - 1u;
    if (halves.y == ONE) halves.y = -slope.y > 1.0 + 1.0 / 4096.0 ? ONE + 1u : ONE - 1u;
    return ldcFromLdi(uvec3(halves, ONE), axis);
}

/// The sample of a triangle in a voxel, as the traversal reads it (peelrayTraceVoxels). `last`: it ends its list.
uvec2 ldcPackSample(LdcTriangle t, uvec3 voxel, uint axis, uint sampling, bool last) {
    const float w = ldcDepthIn(t, peelrayToLdi(vec3(voxel), axis));
    const uint end = last ? 1u << 31u : 0u;
    if (sampling == LDC_CENTRE) return uvec2(floatBitsToUint(w), axis | end);
    const uvec3 normal = ldcHalfNormal(t.slope, axis);
    const uint w_bits = uint(clamp(round((w + 2.0) * (32767.0 / 5.0)), 0.0, 32767.0));
    return uvec2(normal.x | normal.y << 16u, normal.z | w_bits << 16u | end);
}

/// The cells of a pixel's 4x4 grid where a triangle is, a bit each. Conservative: a cell counts when the triangle comes within `margin`
/// pixels of it; the traversal asks for the cell only where it knows the place so well (PEELRAY_UNCERTAIN_PLACE).
uint ldcCoverage(LdcTriangle t, vec2 corner, float margin) {
    const float half_cell = 0.125 + margin;
    const vec3 reach = ldcReach(t) * half_cell;
    const vec2 low = min(t.a.xy, min(t.b.xy, t.c.xy)) - half_cell, high = max(t.a.xy, max(t.b.xy, t.c.xy)) + half_cell;
    const vec2 first = corner + 0.125;
    // From cell to cell an edge function grows by a constant.
    const vec2 e0 = (t.b.xy - t.a.xy) * 0.25, e1 = (t.c.xy - t.b.xy) * 0.25, e2 = (t.a.xy - t.c.xy) * 0.25;
    vec3 row = ldcEdges(t, first) + reach;
    uint coverage = 0u;
    for (uint y = 0u; y < 4u; y++) {
        const float v = first.y + float(y) * 0.25;
        vec3 edges = row;
        for (uint x = 0u; x < 4u; x++) {
            const float u = first.x + float(x) * 0.25;
            const bool inside = min(edges.x, min(edges.y, edges.z)) >= 0.0 && u >= low.x && u <= high.x && v >= low.y && v <= high.y;
            coverage |= inside ? 1u << (y * 4u + x) : 0u;
            edges -= vec3(e0.y, e1.y, e2.y);
        }
        row += vec3(e0.x, e1.x, e2.x);
    }
    return coverage;
}

/// The same of `exact` hits (peelrayMayHit). `id`: of the triangle, and the LDI's axis; `size`: of what counts as a voxel here, in voxels;
/// `margin`: of the coverage (PEELRAY_MARGIN).
uvec4 ldcPackPatch(LdcTriangle t, uvec3 voxel, uint id, float size, float margin, bool last) {
    const vec3 corner = peelrayToLdi(vec3(voxel), id & 3u);
    const float w = (ldcDepthIn(t, corner) - 0.5) * size;
    const uvec3 normal = ldcHalfNormal(t.slope, id & 3u);
    return uvec4(normal.x | normal.y << 16u, normal.z | ldcCoverage(t, corner.xy, margin) << 16u, (floatBitsToUint(w) & ~1u) | (last ? 1u : 0u), id);
}

#endif
