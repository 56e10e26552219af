// Ray traversal of layered depth cubes (docs/frame.md, docs/data.md).
//
// Binding-free: the including shader supplies the fetches, before the #include:
//   PeelrayInstance PEELRAY_INSTANCE(uint i)   cubes placed in the world
//   PeelrayBox PEELRAY_BOX(uint i)    the hierarchy over their boxes
//   uvec2 PEELRAY_TOP(uint i)         the table of 16x16x16-voxel cells
//   uint  PEELRAY_NODE(uint i)        64 entries per occupied cell of it: 4x4x4-voxel nodes
//   uint  PEELRAY_VOXEL(uint i)       64 entries per occupied node: voxels
//   uvec2 PEELRAY_SAMPLE(uint i)      samples, the list of a voxel in a row
//   uint  PEELRAY_SAMPLE_ID(uint i)   triangle id * 4 + axis of the LDI
//   uint  PEELRAY_OFFSET(uint i)      by pixel: where a pixel's samples begin
//   vec2  PEELRAY_RANGE(uint i)       by pixel: least and greatest depth in a block or cell of the pyramid
//   void  PEELRAY_TRIANGLE(uint id, out vec3 a, out vec3 b, out vec3 c)   corners in the body's space (`exact` only)
// and may define
//   PEELRAY_COUNTERS  a PeelrayCounts (peelray/cube.h) that is added to
//   PEELRAY_COUNTED   a bool: whether it is; as a constant false counting costs nothing. Without it: true.
//   PEELRAY_COUNT_RAY(k)   a statement: PEELRAY_COUNTERS are those of the k-th ray from here on (peelrayTraceFour)
//   PEELRAY_ONLY_VOXELS, PEELRAY_ONLY_PIXELS   the other traversals are left out, whatever PeelrayOptions says: half as much for a
//                     driver to read
//   PEELRAY_PRECISE   a bool: true decides hits within rounding of an edge in doubled precision. Without it such a hit is
//                     decided in single precision, watertight all the same: no ray slips between two triangles of a body, but
//                     one in some ten thousand that graze a surface edge-on may see the other of them.
//   PEELRAY_DEFER     a constant bool: true tests triangles after the samples up to the next candidate and not among them, which is the faster
//                     one where every lane runs every branch (software devices)
//   bool PEELRAY_ACCEPT(uint triangle, vec2 uv)   false: the triangle has a hole there, the hit does not count (`exact` only:
//                     other samples are made where there is a surface)
//
// By voxel a cube is walked as an irregular grid (Pérard-Gayot, Kalojanov, Slusallek, Eurographics 2017) on cells that rasterisation
// made: every empty cell knows an empty box around it, which a ray leaves in one step. The instances are leaves of a hierarchy
// of eight boxes a node, in the order of a space-filling curve (Kamel, Faloutsos, CIKM 1993), visited nearest first. By pixel: peelray_pixels.glsl.
#ifndef PEELRAY_GLSL
#define PEELRAY_GLSL

#include "peelray/cube.h"
#include "peelray/intersect.glsl"
#include "peelray/peelray_sample.glsl"
#include "peelray/ray.glsl"

#ifndef PEELRAY_COUNTED
#define PEELRAY_COUNTED true
#endif
#ifdef PEELRAY_COUNTERS
#define PEELRAY_COUNT(what) { if (PEELRAY_COUNTED) PEELRAY_COUNTERS.what++; }
#else
#define PEELRAY_COUNT(what) {}
#endif
#ifndef PEELRAY_COUNT_RAY
#define PEELRAY_COUNT_RAY(k)
#endif

#ifdef PEELRAY_PRECISE
#define PEELRAY_DECIDES PEELRAY_PRECISE
#else
#define PEELRAY_DECIDES false
#endif
#ifndef PEELRAY_DEFER
#define PEELRAY_DEFER false
#endif

/// How rays are traced. Constants, but for tolerance and block.
struct PeelrayOptions {
    bool any_hit;     ///< some hit instead of the nearest
    uint hit;         ///< PEELRAY_EXACT, ...
    uint traversal;   ///< PEELRAY_VOXELS, ...
    float tolerance;  ///< world units
    uvec2 block;      ///< pixels of a block of the coarse level along u and v
    uint batch;       ///< by pixel: PEELRAY_ONE, ...; a constant
    uint instances;   ///< a constant: how many there are, 1 to 8; 0: any number
};

/// Where a line enters and leaves the box [0, size].
vec2 peelrayClip(vec3 o, vec3 inv, vec3 size) {
    const vec3 a = -o * inv, b = (size - o) * inv;
    const vec3 near = min(a, b), far = max(a, b);
    return vec2(max(near.x, max(near.y, near.z)), min(far.x, min(far.y, far.z)));
}

/// 2^-e of the largest component of a vector (1 <= largest * result < 2), for scaling without rounding.
float peelrayScale(float largest) {
    const int exponent = int((floatBitsToUint(largest) >> 23) & 255u) - 127;
    return exponent < -126 ? 1.0 / largest : ldexp(1.0, -exponent);
}

vec3 peelrayInverse(vec3 d) {
    return vec3(1.0) / vec3(abs(d.x) < 1e-12 ? (d.x < 0.0 ? -1e-12 : 1e-12) : d.x,
                            abs(d.y) < 1e-12 ? (d.y < 0.0 ? -1e-12 : 1e-12) : d.y,
                            abs(d.z) < 1e-12 ? (d.z < 0.0 ? -1e-12 : 1e-12) : d.z);
}

vec3 peelrayTurn(PeelrayInstance place, vec3 v) { return vec3(dot(place.x, v), dot(place.y, v), dot(place.z, v)); }

/// A ray in a cube's voxel space: o + s * d, where d is the ray's direction there times a power of two (exact), largest component
/// about 1, and s = t * s_per_t - s_shift.
struct PeelrayLocal {
    vec3 start;      ///< its origin, from the cube's corner, in the units of the body's space
    vec3 o, d, inv;  ///< inv: 1 / d
    ivec3 last;      ///< the cube's last voxel
    float s_per_t, s_shift;
    float s_min;
    float s_best;    ///< the nearest hit so far, or the end of the ray
    float s_begin, s_end;  ///< in the cube
    vec3 tolerance;        ///< of `tolerance` hits along each axis, voxels
};

/// The ray as far as a hit at `t_best`; false: it does not meet the cube.
bool peelrayEnterCube(PeelrayInstance place, PeelrayRay ray, float t_best, PeelrayOptions options, out PeelrayLocal r) {
    const uvec3 tops = uvec3(place.tops, place.tops >> 10u, place.tops >> 20u) & 1023u;
    r.last = ivec3(tops) * 16 - 1;
    const vec3 turned = peelrayTurn(place, ray.direction), turned_abs = abs(turned);
    const float scale = peelrayScale(max(turned_abs.x, max(turned_abs.y, turned_abs.z)));
    r.d = turned * scale;
    r.s_per_t = place.inv_voxel / scale;
    r.inv = peelrayInverse(r.d);
    r.tolerance = vec3(0);
    if (options.hit == PEELRAY_TOLERANCE)
        // How long a unit of the world along an axis of the cube is there; exact for transforms without shear.
        r.tolerance = options.tolerance * place.inv_voxel * vec3(length(place.x), length(place.y), length(place.z));
    const vec3 size = vec3(tops) * 16.0;

    // A ray that starts outside the box is moved to it first, rounding once, so that a far origin costs no precision.
    r.start = peelrayTurn(place, ray.origin - place.corner);
    r.o = r.start * place.inv_voxel;
    vec2 inside = peelrayClip(r.o, r.inv, size);
    r.s_shift = 0.0;
    if (inside.x > 0.0 || inside.y < 0.0) {
        // To a little before the box: far away the place of entry is known only to some voxels.
        const float rounding = 1e-6 * abs(inside.x) + 1.0;
        if (!(inside.x <= inside.y + rounding)) return false;
        const float along = (inside.x - rounding) / r.s_per_t;
        r.s_shift = along * r.s_per_t;
        r.start = peelrayTurn(place, vec3(peelrayFusedSum(peelrayTwoSum(ray.origin.x, -place.corner.x), along, ray.direction.x),
                                          peelrayFusedSum(peelrayTwoSum(ray.origin.y, -place.corner.y), along, ray.direction.y),
                                          peelrayFusedSum(peelrayTwoSum(ray.origin.z, -place.corner.z), along, ray.direction.z)));
        r.o = r.start * place.inv_voxel;
        inside = peelrayClip(r.o, r.inv, size);
    }
    r.s_min = ray.tmin * r.s_per_t - r.s_shift;
    r.s_best = t_best * r.s_per_t - r.s_shift;
    r.s_begin = max(r.s_min, inside.x);
    r.s_end = min(r.s_best, inside.y);
    return r.s_begin <= r.s_end;
}

/// Does a hit at `s_hit` take the place of what the ray has hit so far? Of two at the same place that of the smaller number counts: lists
/// are in no order.
bool peelrayNearer(PeelrayLocal r, float s_hit, uint id, PeelrayHit hit) {
    return s_hit > r.s_min && (s_hit < r.s_best || (s_hit == r.s_best && hit.triangle != PEELRAY_MISS && id < hit.triangle));
}

/// `exact`: does the ray hit this triangle nearer than what it has hit so far? Then that is in `r` and `hit`.
bool peelrayTestTriangle(PeelrayInstance place, PeelrayRay ray, uint id, PeelrayShear shear, inout PeelrayLocal r, inout PeelrayHit hit) {
    PEELRAY_COUNT(triangles);
    vec3 a, b, c;
    PEELRAY_TRIANGLE(id, a, b, c);
    float t;
    vec2 uv;
    uint found = peelrayIntersectSheared(r.start, shear, a - place.origin, b - place.origin, c - place.origin, PEELRAY_DECIDES, t, uv);
    float s_hit = t * place.inv_voxel;
#ifdef PEELRAY_PRECISE
    if (PEELRAY_PRECISE && found >= PEELRAY_UNCERTAIN) {
        const vec2 x = peelrayTwoSum(r.start.x, place.origin.x), y = peelrayTwoSum(r.start.y, place.origin.y),
                   z = peelrayTwoSum(r.start.z, place.origin.z);
        const bool as_given = r.s_shift == 0.0 && place.moved == 0u;
        found = peelrayIntersectPrecise(as_given ? ray.origin : vec3(x.x, y.x, z.x), as_given ? vec3(0) : vec3(x.y, y.y, z.y), r.d, a, b, c, t,
                                        uv) ? PEELRAY_INSIDE : PEELRAY_OUTSIDE;
        s_hit = t * place.inv_voxel;
    }
#endif
    if ((found & PEELRAY_INSIDE) == 0u || !peelrayNearer(r, s_hit, id, hit)) return false;
#ifdef PEELRAY_ACCEPT
    if (!PEELRAY_ACCEPT(id, uv)) return false;
#endif
    r.s_best = s_hit;
    hit.triangle = id;
    hit.uv = uv;
    return true;
}

/// `tolerance`: where a ray, while it is in the column of the pixel [0, 1] x [0, 1], comes nearest in depth to a sample at depth `w`;
/// false: it stays farther from it than `tolerance` (voxels), or what it has hit lies before (peelrayNearer decides). `o`, `d`, `inv` as the LDI sees them.
bool peelrayTestDepth(PeelrayLocal r, float tolerance, vec3 o, vec3 d, vec3 inv, float w, out float s) {
    const vec2 a = -o.xy * inv.xy, b = (1.0 - o.xy) * inv.xy;
    const vec2 enters = min(a, b), leaves = max(a, b);
    const float s_in = max(r.s_min, max(enters.x, enters.y)), s_out = min(r.s_end, min(leaves.x, leaves.y));
    s = abs(d.z) < 1e-12 ? s_in : clamp((w - o.z) * inv.z, s_in, max(s_in, s_out));
    return s_in <= s_out && abs(o.z + s * d.z - w) <= tolerance && s > r.s_min && s <= r.s_best;
}

/// What the samples of a list are tested with: where the ray enters and leaves their cell, from the cell's centre, voxels.
struct PeelraySegment {
    vec3 enters, leaves;
};

/// `exact`: may the ray hit the triangle of this sample inside the cell? Conservative: the sample's plane passes between the
/// segment's ends, and the triangle is in the part of the pixel where the ray meets it.
bool peelrayMayHit(uvec2 data, PeelraySegment segment) {
    // word 0: w (16 bits: [-2, 3] voxels from the voxel's corner), coverage (16 bits: 4x4 cells of the pixel);
    // word 1: slopes (2x14 bits: PEELRAY_SLOPE_RANGE), axis (2 bits), last of its list (1 bit)
    const float unit = 8191.0 / PEELRAY_SLOPE_RANGE;  // of the slopes as they are stored
    const float su = float(bitfieldExtract(int(data.y), 0, 14)), sv = float(bitfieldExtract(int(data.y), 14, 14));
    const float w = float(data.x & 0xffffu) * (5.0 / 65535.0 * unit) - 2.5 * unit;
    const bool x = (data.y & (3u << 28u)) == 0u, y = (data.y & (1u << 28u)) != 0u;
    const vec3 normal = vec3(x ? unit : (y ? -sv : -su), x ? -su : (y ? unit : -sv), x ? -sv : (y ? -su : unit));
    const float f0 = dot(normal, segment.enters) - w, f1 = dot(normal, segment.leaves) - w;
    // Written so that a NaN passes.
    if (min(f0, f1) > PEELRAY_SEGMENT_SLACK * unit || max(f0, f1) < -PEELRAY_SEGMENT_SLACK * unit) return false;
    if (!(abs(f0 - f1) > PEELRAY_UNCERTAIN_PLACE * unit)) return true;
    const vec3 at = mix(segment.enters, segment.leaves, clamp(f0 / (f0 - f1), 0.0, 1.0));
    const vec2 pixel = x ? at.yz : (y ? at.zx : at.xy);
    const uvec2 bit = uvec2(clamp(pixel * 4.0 + 2.0, vec2(0), vec2(3)));
    return (data.x >> (16u + bit.y * 4u + bit.x) & 1u) != 0u;
}

/// Nearest hit of a ray in one instance's cube, by voxel, with tmin < t < hit.t replaces `hit`; with any_hit: some hit. The ray is
/// valid (peelrayTrace), `skip` a triangle that does not count.
void peelrayTraceVoxels(uint instance, PeelrayRay ray, uint skip, PeelrayOptions options, inout PeelrayHit hit) {
    const PeelrayInstance place = PEELRAY_INSTANCE(instance);
    PeelrayLocal r;
    if (!peelrayEnterCube(place, ray, hit.t, options, r)) return;
    const uvec3 tops = uvec3(r.last + 1) >> 4u;
    // Cells are walked in a mirrored space, where the ray goes up along every axis: mirrored coordinates are ~coordinate.
    const bvec3 up = greaterThanEqual(r.d, vec3(0));
    const ivec3 mirror = ivec3(up.x ? 0 : -1, up.y ? 0 : -1, up.z ? 0 : -1);
    const vec3 o_inv = r.o * r.inv;
    // Of a packed box only the end that the ray leaves through is looked at.
    const uvec3 ahead = uvec3(up.x ? 6u : 0u, up.y ? 8u : 2u, up.z ? 10u : 4u);
    const PeelrayShear shear = peelrayShear(r.d);
    float s = r.s_begin;
    ivec3 cell = clamp(ivec3(floor(r.o + s * r.d)), ivec3(0), r.last) ^ mirror;
    bool found_one = false;

    while (true) {
        PEELRAY_COUNT(steps);
        // The cell's entry: a list of samples, or an empty box. `last`: the box's last cell along the ray.
        const uvec3 at = uvec3(cell ^ mirror);
        const uvec3 top = at >> 4u;
        const uvec2 top_entry = PEELRAY_TOP(place.first_cell + (top.z * tops.y + top.y) * tops.x + top.x);
        ivec3 last;
        bool more = false;  // the list has samples left
        uint j = 0u;        // its next sample
        if ((top_entry.x >> 31u) == 0u) {
            const uvec3 word = uvec3(up.x ? top_entry.y : top_entry.x, up.y ? top_entry.y : top_entry.x, up.z ? top_entry.y : top_entry.x);
            last = (ivec3(word.x & 1023u, word.y >> 10u & 1023u, word.z >> 20u & 1023u) << 4 ^ mirror) | 15;
        } else {
            const uvec3 in_top = at >> 2u & 3u;
            uint entry = PEELRAY_NODE(top_entry.y * 64u + in_top.z * 16u + in_top.y * 4u + in_top.x);
            int scale = 2;
            if ((entry >> 31u) != 0u) {
                const uvec3 in_node = at & 3u;
                entry = PEELRAY_VOXEL((entry & 0x7fffffffu) * 64u + in_node.z * 16u + in_node.y * 4u + in_node.x);
                scale = 0;
                more = (entry >> 31u) != 0u;
                j = entry & 0x7fffffffu;
            }
            const int inside = more ? 0 : (4 << scale) - 1;
            const uvec3 end = more ? uvec3(0) : (uvec3(entry) >> ahead & 3u) << scale;
            last = (((ivec3(at) & ~inside) | ivec3(end)) ^ mirror) | ((1 << scale) - 1);
        }
        const vec3 exits = vec3(last + 1) * abs(r.inv) - o_inv;
        const float s_out = min(exits.x, min(exits.y, exits.z));

        if (more) {
            PEELRAY_COUNT(cells);
            if (options.hit == PEELRAY_EXACT) {
                PeelraySegment segment;
                const vec3 from_centre = r.o - (vec3(at) + 0.5);
                segment.enters = from_centre + s * r.d;
                segment.leaves = from_centre + min(s_out, r.s_best) * r.d;
                // Triangles may be tested together after the samples of neighbouring rays: PEELRAY_DEFER.
                do {
                    uint candidate = PEELRAY_MISS;
                    while (more && candidate == PEELRAY_MISS && !(options.any_hit && found_one)) {
                        PEELRAY_COUNT(samples);
                        const uvec2 data = PEELRAY_SAMPLE(j);
                        more = (data.y >> 30u & 1u) == 0u;
                        if (peelrayMayHit(data, segment)) {
                            const uint id = PEELRAY_SAMPLE_ID(j) >> 2u;
                            if (id != skip) {
                                if (PEELRAY_DEFER)
                                    candidate = id;
                                else if (peelrayTestTriangle(place, ray, id, shear, r, hit))
                                    found_one = true;
                            }
                        }
                        j++;
                    }
                    if (PEELRAY_DEFER && candidate != PEELRAY_MISS && peelrayTestTriangle(place, ray, candidate, shear, r, hit)) found_one = true;
                } while (PEELRAY_DEFER && more && !(options.any_hit && found_one));
            } else {
                const vec3 o_cell = r.o - vec3(at);
                while (more) {
                    PEELRAY_COUNT(samples);
                    const uvec2 data = PEELRAY_SAMPLE(j);
                    const uint axis = data.y >> 28u & 3u;
                    const float w = float(data.x & 0xffffu) * (5.0 / 65535.0) - 2.0;
                    const vec3 dr = peelrayToLdi(r.d, axis), or = peelrayToLdi(o_cell, axis);
                    bool hits;
                    float s_hit;
                    if (options.hit == PEELRAY_TOLERANCE) {
                        hits = peelrayTestDepth(r, r.tolerance[axis], or, dr, peelrayToLdi(r.inv, axis), w, s_hit);
                    } else {
                        const vec2 slope = vec2(bitfieldExtract(int(data.y), 0, 14), bitfieldExtract(int(data.y), 14, 14)) * (PEELRAY_SLOPE_RANGE / 8191.0);
                        const vec2 centre = or.xy - 0.5;
                        s_hit = (w + dot(slope, centre) - or.z) / (dr.z - dot(slope, dr.xy));
                        const vec2 pixel = centre + s_hit * dr.xy;
                        hits = s_hit > r.s_min && s_hit <= r.s_best && abs(pixel.x) <= PEELRAY_FOOTPRINT && abs(pixel.y) <= PEELRAY_FOOTPRINT;
                    }
                    if (hits) {
                        const uint id = PEELRAY_SAMPLE_ID(j) >> 2u;
                        if (id != skip && peelrayNearer(r, s_hit, id, hit)) {
                            r.s_best = s_hit;
                            hit.triangle = id;
                            found_one = true;
                        }
                    }
                    more = (data.y >> 30u & 1u) == 0u;
                    j++;
                }
            }
            if (options.any_hit && found_one) break;
        }

        if (s_out >= min(r.s_end, r.s_best)) break;
        // Leave through the exit face; the other coordinates come from the position but never step backwards or out of the
        // box.
        s = max(s, s_out);
        cell = clamp(ivec3(floor(r.o + s * r.d)) ^ mirror, cell, last);
        if (exits.x <= exits.y && exits.x <= exits.z)
            cell.x = last.x + 1;
        else if (exits.y <= exits.z)
            cell.y = last.y + 1;
        else
            cell.z = last.z + 1;
        if (any(greaterThan(uvec3(cell ^ mirror), uvec3(r.last)))) break;
    }
    if (found_one) {
        hit.t = (r.s_best + r.s_shift) / r.s_per_t;
        hit.instance = instance;
    }
}

/// Where a ray enters a box of the hierarchy, as an integer of the same order; PEELRAY_MISS: it does not, before `t_max`.
uint peelrayEnter(PeelrayBox box, vec3 origin, vec3 inv, float t_min, float t_max) {
    const vec3 a = (box.lower - origin) * inv, b = (box.upper - origin) * inv;
    const vec3 near = min(a, b), far = max(a, b);
    float enter = max(near.x, max(near.y, near.z)), leave = min(far.x, min(far.y, far.z));
    // Far away both are known to some share of themselves only.
    enter -= 2e-6 * abs(enter);
    leave += 2e-6 * abs(leave);
    enter = max(enter, t_min);
    // Written so that a NaN (a ray in a face of the box) passes.
    if (box.lower.x > box.upper.x || enter > leave || enter > t_max) return PEELRAY_MISS;
    const uint bits = floatBitsToUint(enter);
    return (bits & 0x80000000u) != 0u ? ~bits : bits | 0x80000000u;
}

/// Which of the boxes from `first` on, at most eight, a ray meets, nearest first: three bits each, their number in bits 24 to 27.
/// `boxes`: how many, a constant.
uint peelrayMeet(uint first, uint boxes, vec3 origin, vec3 inv, float t_min, float t_max) {
    uint keys[8];
    uint count = 0u;
#define PEELRAY_KEY(i)                                                                                     \
    {                                                                                                      \
        keys[i] = PEELRAY_MISS;                                                                            \
        if (boxes > uint(i)) {                                                                                \
            const uint key = peelrayEnter(PEELRAY_BOX(first + uint(i)), origin, inv, t_min, t_max);           \
            count += key != PEELRAY_MISS ? 1u : 0u;                                                        \
            keys[i] = (key & ~7u) | uint(i); /* misses stay last */                                           \
        }                                                                                                  \
    }
    PEELRAY_KEY(0) PEELRAY_KEY(1) PEELRAY_KEY(2) PEELRAY_KEY(3) PEELRAY_KEY(4) PEELRAY_KEY(5) PEELRAY_KEY(6) PEELRAY_KEY(7)
#undef PEELRAY_KEY
#define PEELRAY_SWAP(i, j)                            \
    if (boxes > uint(j)) {                               \
        const uint smaller = min(keys[i], keys[j]);   \
        keys[j] = max(keys[i], keys[j]);              \
        keys[i] = smaller;                            \
    }
    // Batcher's network of 19 exchanges.
    PEELRAY_SWAP(0, 1) PEELRAY_SWAP(2, 3) PEELRAY_SWAP(4, 5) PEELRAY_SWAP(6, 7)
    PEELRAY_SWAP(0, 2) PEELRAY_SWAP(1, 3) PEELRAY_SWAP(4, 6) PEELRAY_SWAP(5, 7)
    PEELRAY_SWAP(1, 2) PEELRAY_SWAP(5, 6) PEELRAY_SWAP(0, 4) PEELRAY_SWAP(3, 7)
    PEELRAY_SWAP(1, 5) PEELRAY_SWAP(2, 6)
    PEELRAY_SWAP(1, 4) PEELRAY_SWAP(3, 6)
    PEELRAY_SWAP(2, 4) PEELRAY_SWAP(3, 5)
    PEELRAY_SWAP(3, 4)
#undef PEELRAY_SWAP
    return count << 24u | (keys[0] & 7u) | (keys[1] & 7u) << 3u | (keys[2] & 7u) << 6u | (keys[3] & 7u) << 9u | (keys[4] & 7u) << 12u |
           (keys[5] & 7u) << 15u | (keys[6] & 7u) << 18u | (keys[7] & 7u) << 21u;
}

/// Makes t count in lengths of a direction whose largest component is in [1, 2): by `scale`. False: the ray is not valid.
bool peelrayNormalise(inout PeelrayRay ray, out float scale) {
    scale = 1.0;
    const vec3 d_abs = abs(ray.direction);
    const float d_max = max(d_abs.x, max(d_abs.y, d_abs.z));
    // Written so that a NaN fails.
    if (!(d_max > 0.0 && d_max < 3e38 && d_abs.x <= d_max && d_abs.y <= d_max && d_abs.z <= d_max)) return false;
    const vec3 o_abs = abs(ray.origin);
    if (!(ray.tmin < ray.tmax && abs(ray.tmin) < 3e38 && o_abs.x < 3e38 && o_abs.y < 3e38 && o_abs.z < 3e38)) return false;
    scale = peelrayScale(d_max);
    ray.direction *= scale;
    ray.tmin /= scale;
    ray.tmax /= scale;
    return true;
}

#ifndef PEELRAY_ONLY_VOXELS
#include "peelray/peelray_pixels.glsl"
#endif

/// Nearest hit in one instance's cube, in the order in which the cubes are stored.
void peelrayTraceInstance(uint instance, PeelrayRay ray, uvec2 skip, PeelrayOptions options, inout PeelrayHit hit) {
    const uint own = skip.x == instance ? skip.y : PEELRAY_MISS;
#if defined(PEELRAY_ONLY_VOXELS)
    peelrayTraceVoxels(instance, ray, own, options, hit);
#elif defined(PEELRAY_ONLY_PIXELS)
    peelrayTracePixels(instance, ray, own, options, hit);
#else
    if (options.traversal == PEELRAY_VOXELS)
        peelrayTraceVoxels(instance, ray, own, options, hit);
    else
        peelrayTracePixels(instance, ray, own, options, hit);
#endif
}

/// Walks the hierarchy over any number of instances, nearest first.
void peelrayTraceTree(PeelrayTree tree, PeelrayRay ray, vec3 inv, uvec2 skip, PeelrayOptions options, inout PeelrayHit hit) {
    uint waiting[PEELRAY_TREE_LEVELS];  // what is left of the higher levels, as peelrayMeet gives it
    uint level = tree.levels - 1u, group = 0u;
    bool enters = true;
    uint word = 0u;
    while (true) {
        if (enters) word = peelrayMeet(tree.first[level] + group * 8u, 8u, ray.origin, inv, ray.tmin, hit.t);
        enters = false;
        if ((word >> 24u) == 0u) {
            level++;
            if (level >= tree.levels) break;
            word = waiting[level];
            group >>= 3u;
            continue;
        }
        const uint index = group * 8u + (word & 7u);
        word = ((word >> 24u) - 1u) << 24u | (word >> 3u & 0x1fffffu);
        const PeelrayBox box = PEELRAY_BOX(tree.first[level] + index);
        // A hit found in between may lie before it; then it lies before all that are left of this group.
        if (peelrayEnter(box, ray.origin, inv, ray.tmin, hit.t) == PEELRAY_MISS) {
            word = 0u;
            continue;
        }
        if (level > 0u) {
            waiting[level] = word;
            level--;
            group = index;
            enters = true;
            continue;
        }
        peelrayTraceInstance(box.instance, ray, skip, options, hit);
        if (options.any_hit && hit.triangle != PEELRAY_MISS) break;
    }
}

/// First hit of a ray in all instances with tmin < t < tmax. `skip`: instance and triangle that do not count (PEELRAY_MISS: none).
///
/// A ray with a NaN or infinite component (but for tmax), a zero direction or tmin >= tmax misses. Denormal direction
/// components may count as zero.
PeelrayHit peelrayTrace(PeelrayTree tree, PeelrayRay ray, uvec2 skip, PeelrayOptions options) {
    const float infinity = uintBitsToFloat(0x7f800000u);
    const PeelrayHit miss = PeelrayHit(infinity, PEELRAY_MISS, PEELRAY_MISS, vec2(0));
    float scale;
    if (!peelrayNormalise(ray, scale)) return miss;
    PeelrayHit hit = miss;
    hit.t = ray.tmax;
    const vec3 inv = peelrayInverse(ray.direction);
    if (options.instances == 1u) {
        peelrayTraceInstance(0u, ray, skip, options, hit);
    } else if (options.instances != 0u) {
        uint word = peelrayMeet(tree.first[0], options.instances, ray.origin, inv, ray.tmin, hit.t);
        for (; (word >> 24u) != 0u; word = ((word >> 24u) - 1u) << 24u | (word >> 3u & 0x1fffffu)) {
            const PeelrayBox box = PEELRAY_BOX(tree.first[0] + (word & 7u));
            // A hit found in between may lie before it; then it lies before all that are left.
            if (hit.triangle != PEELRAY_MISS && peelrayEnter(box, ray.origin, inv, ray.tmin, hit.t) == PEELRAY_MISS) break;
            peelrayTraceInstance(box.instance, ray, skip, options, hit);
            if (options.any_hit && hit.triangle != PEELRAY_MISS) break;
        }
    } else {
        peelrayTraceTree(tree, ray, inv, skip, options, hit);
    }
    hit.t = hit.triangle == PEELRAY_MISS ? infinity : hit.t * scale;
    return hit;
}

#endif
