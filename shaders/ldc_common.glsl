// What the passes that build the cube share: a triangle as one LDI sees it, the packing of keys, masks of 4x4x4 cells.
#ifndef PEELRAY_LDC_COMMON_GLSL
#define PEELRAY_LDC_COMMON_GLSL

#include "common.glsl"
#include "params.h"
#include "peelray/peelray_sample.glsl"
#include "peelray/precise.glsl"

// Filed this far beyond its own extent, in voxels, so that rounding (coordinates up to 2048) never loses a sample; half of
// the traversal's slack.
const float LDC_SLACK = 1e-3;
// Large triangles are cut into blocks of so many pixels a side.
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

LdcTriangle ldcProject(CubeGrid grid, vec3 a, vec3 b, vec3 c, vec3 normal, uint axis) {
    LdcTriangle t;
    t.a = peelrayToLdi((a - grid.origin) * grid.inv_voxel, axis);
    t.b = peelrayToLdi((b - grid.origin) * grid.inv_voxel, axis);
    t.c = peelrayToLdi((c - grid.origin) * grid.inv_voxel, axis);
    const vec3 n = peelrayToLdi(normal, axis);
    t.slope = clamp(-n.xy / n.z, vec2(-PEELRAY_SLOPE_RANGE), vec2(PEELRAY_SLOPE_RANGE));
    if (n.z < 0.0) {
        const vec3 swapped = t.b;
        t.b = t.c;
        t.c = swapped;
    }
    return t;
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

/// Did the stages before the samples fit? Otherwise they are all redone.
#define LDC_FITS(counts) \
    (counts.cells <= params.cell_capacity && counts.occupied <= params.occupied_capacity && counts.nodes <= params.node_capacity)

// --- Keys ---

uint ldcTopIndex(uvec3 voxel, uvec3 dims) {
    const uvec3 top = voxel >> 4u, tops = dims >> 4u;
    return (top.z * tops.y + top.y) * tops.x + top.x;
}
uvec3 ldcTopCell(uint index, uvec3 dims) {
    const uvec3 tops = dims >> 4u;
    return uvec3(index % tops.x, (index / tops.x) % tops.y, index / (tops.x * tops.y));
}
uint ldcNodeInTop(uvec3 voxel) {
    const uvec3 n = (voxel >> 2u) & 3u;
    return n.z * 16u + n.y * 4u + n.x;
}
uint ldcVoxelInNode(uvec3 voxel) {
    const uvec3 n = voxel & 3u;
    return n.z * 16u + n.y * 4u + n.x;
}
/// A pixel of a body's three LDIs, which lie one behind the other.
uint ldcPixelOfBody(uvec2 pixel, uint axis, uvec3 dims) {
    const uint before = axis == 0u ? 0u : dims.y * dims.z + (axis == 1u ? 0u : dims.z * dims.x);
    return before + peelrayPixelIndex(pixel, uint(peelrayToLdi(vec3(dims), axis).x));
}
/// What a half float holds of a number in [0, 1], rounded to nearest even. In integers: compilers take packing and unpacking
/// one after the other for nothing.
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

/// The sample of a triangle in a voxel, as the traversal reads it (see peelrayMayHit); the `last` bit is still 0.
uvec2 ldcPackSample(LdcTriangle t, uvec3 voxel, uint axis, uint sampling) {
    const vec3 corner = peelrayToLdi(vec3(voxel), axis);
    const vec2 centre = corner.xy + 0.5;
    const float w = ldcDepth(t, centre) - corner.z;
    uint coverage = 0u;
    if (sampling == LDC_CONSERVATIVE) {
        // Conservative: a cell of the 4x4 grid counts when the triangle comes within 0.03 pixels of it: the traversal asks for the
        // cell only where it knows the place so well (PEELRAY_UNCERTAIN_PLACE).
        const float half_cell = 0.125 + 0.03;
        const vec3 reach = ldcReach(t) * half_cell;
        const vec2 low = min(t.a.xy, min(t.b.xy, t.c.xy)) - half_cell, high = max(t.a.xy, max(t.b.xy, t.c.xy)) + half_cell;
        const vec2 first = corner.xy + 0.125;
        // From cell to cell an edge function grows by a constant.
        const vec2 e0 = (t.b.xy - t.a.xy) * 0.25, e1 = (t.c.xy - t.b.xy) * 0.25, e2 = (t.a.xy - t.c.xy) * 0.25;
        vec3 row = ldcEdges(t, first) + reach;
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
    }
    const uint w_bits = uint(clamp(round((w + 2.0) * (65535.0 / 5.0)), 0.0, 65535.0));
    const ivec2 slope = ivec2(round(t.slope * (8191.0 / PEELRAY_SLOPE_RANGE)));
    return uvec2(w_bits | coverage << 16u, (uint(slope.x) & 0x3fffu) | (uint(slope.y) & 0x3fffu) << 14u | axis << 28u);
}

#endif
