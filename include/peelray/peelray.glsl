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
//   uvec4 PEELRAY_PATCH(uint i)       `exact` by voxel: samples and their ids in one (ldcPackPatch)
//   uint  PEELRAY_OFFSET(uint i)      by pixel: where a pixel's samples begin
//   vec2  PEELRAY_RANGE(uint i)       by pixel: least and greatest depth in a block or cell of the pyramid
//   void  PEELRAY_TRIANGLE(uint id, out vec3 a, out vec3 b, out vec3 c)   corners in the body's space (`exact` by pixel, and bare bodies)
//   void  PEELRAY_CORNERS(uint id, out vec3 a, out vec3 b, out vec3 c)   the same from the grid's origin (`exact` by voxel)
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
//   void PEELRAY_VISIT(uint instance)   told of each instance before the ray looks for hits in it, for hooks that must know which one a
//                     triangle belongs to
//   bool PEELRAY_SHOWN(uint triangle, bool front)   false: the triangle is not there for a ray that meets this side of it; front: that from
//                     which its corners go counter-clockwise in the body's space. Asked by every hit test, of samples by PEELRAY_TRIANGLE.
//                     A macro that looks at `front` last costs nothing where all triangles show both sides.
//
// By voxel: peelray_voxels.glsl, by pixel: peelray_pixels.glsl. The instances are leaves of a hierarchy of eight boxes a node, in the
// order of a space-filling curve (Kamel, Faloutsos, CIKM 1993), visited nearest first.
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
    uint bare;        ///< a constant: of 1 to 8 instances the first so many boxes are those of bare bodies
    bool refined;     ///< a constant: by voxel and `exact`: voxels may be refined
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

/// A cube's grid in 16 voxels.
uvec3 peelrayTops(PeelrayInstance place) { return uvec3(place.tops, place.tops >> 10u, place.tops >> 20u) & 1023u; }

vec3 peelrayTurn(PeelrayInstance place, vec3 v) { return vec3(dot(place.x, v), dot(place.y, v), dot(place.z, v)); }

/// How far outside a cube a ray may start for its coordinates to be precise enough: voxels, and lengths of the longest side.
const float PEELRAY_NEAR = 2048.0, PEELRAY_NEAR_SIZES = 4.0;

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

/// Direction and start of the ray in the cube's space, and how its parameter counts there; not yet moved. Returns its scale: d is
/// `scale` times the direction.
float peelrayIntoBody(PeelrayInstance place, PeelrayRay ray, inout PeelrayLocal r) {
    const vec3 turned = peelrayTurn(place, ray.direction), turned_abs = abs(turned);
    const float scale = peelrayScale(max(turned_abs.x, max(turned_abs.y, turned_abs.z)));
    r.d = turned * scale;
    r.s_per_t = place.inv_voxel / scale;
    r.start = peelrayTurn(place, ray.origin - place.corner);
    r.s_shift = 0.0;
    return scale;
}

/// Where a ray is after so many lengths of its direction, from the cube's corner in the units of the body's space: rounded once.
vec3 peelrayStartAt(PeelrayInstance place, PeelrayRay ray, float along) {
    return peelrayTurn(place, vec3(peelrayFusedSum(peelrayTwoSum(ray.origin.x, -place.corner.x), along, ray.direction.x),
                                   peelrayFusedSum(peelrayTwoSum(ray.origin.y, -place.corner.y), along, ray.direction.y),
                                   peelrayFusedSum(peelrayTwoSum(ray.origin.z, -place.corner.z), along, ray.direction.z)));
}

/// The ray as far as a hit at `t_best`; false: it does not meet the cube.
bool peelrayEnterCube(PeelrayInstance place, PeelrayRay ray, float t_best, PeelrayOptions options, out PeelrayLocal r) {
    const uvec3 tops = peelrayTops(place);
    r.last = ivec3(tops) * 16 - 1;
    peelrayIntoBody(place, ray, r);
    r.inv = peelrayInverse(r.d);
    r.tolerance = vec3(0);
    if (options.hit == PEELRAY_TOLERANCE)
        // How long a unit of the world along an axis of the cube is there; exact for transforms without shear.
        r.tolerance = options.tolerance * place.inv_voxel * vec3(length(place.x), length(place.y), length(place.z));
    const vec3 size = vec3(tops) * 16.0;

    // A ray that starts far outside the box is moved to it first, rounding once, so that a far origin costs no precision.
    r.o = r.start * place.inv_voxel;
    vec2 inside = peelrayClip(r.o, r.inv, size);
    const vec3 away = abs(r.o);
    const float near = min(PEELRAY_NEAR_SIZES * max(size.x, max(size.y, size.z)), PEELRAY_NEAR);
    if ((inside.x > 0.0 || inside.y < 0.0) && !(max(away.x, max(away.y, away.z)) <= near)) {
        // To a little before the box: far away the place of entry is known only to some voxels.
        const float rounding = 1e-6 * abs(inside.x) + 1.0;
        if (!(inside.x <= inside.y + rounding)) return false;
        const float along = (inside.x - rounding) / r.s_per_t;
        r.s_shift = along * r.s_per_t;
        r.start = peelrayStartAt(place, ray, along);
        r.o = r.start * place.inv_voxel;
        inside = peelrayClip(r.o, r.inv, size);
    }
    r.s_min = ray.tmin * r.s_per_t - r.s_shift;
    r.s_best = t_best * r.s_per_t - r.s_shift;
    r.s_begin = max(r.s_min, inside.x);
    r.s_end = min(r.s_best, inside.y);
    return r.s_begin <= r.s_end;
}

/// Stores how far the nearest hit in an instance is.
void peelrayKeep(PeelrayLocal r, uint instance, inout PeelrayHit hit) {
    hit.t = (r.s_best + r.s_shift) / r.s_per_t;
    hit.instance = instance;
}

/// Does a hit at `s_hit` take the place of what the ray has hit so far? Of two at the same place that of the smaller number counts: lists
/// are in no order.
bool peelrayNearer(PeelrayLocal r, float s_hit, uint id, PeelrayHit hit) {
    return s_hit > r.s_min && (s_hit < r.s_best || (s_hit == r.s_best && hit.triangle != PEELRAY_MISS && id < hit.triangle));
}

/// Does a ray along `direction` come from the front of the triangle, whence its corners go counter-clockwise?
bool peelrayFront(vec3 direction, vec3 a, vec3 b, vec3 c) { return dot(cross(b - a, c - a), direction) < 0.0; }

/// The same of a triangle by number; a direction in its body's space.
bool peelrayFrontOf(vec3 direction, uint id) {
    vec3 a, b, c;
    PEELRAY_TRIANGLE(id, a, b, c);
    return peelrayFront(direction, a, b, c);
}

/// A hit of a sample: is its triangle there for the ray?
bool peelraySampleShown(vec3 direction, uint id) {
#ifdef PEELRAY_SHOWN
    return PEELRAY_SHOWN(id, peelrayFrontOf(direction, id));
#else
    return true;
#endif
}

/// `exact`: does the ray hit this triangle nearer than what it has hit so far? Then that is in `r` and `hit`.
/// `from_grid`, a constant: its corners are there as PEELRAY_CORNERS.
bool peelrayTestTriangle(PeelrayInstance place, PeelrayRay ray, uint id, bool from_grid, PeelrayShear shear, inout PeelrayLocal r,
                         inout PeelrayHit hit) {
    PEELRAY_COUNT(triangles);
    vec3 a, b, c;
#ifndef PEELRAY_ONLY_PIXELS
    if (from_grid) {
        PEELRAY_CORNERS(id, a, b, c);
    } else
#endif
    {
        PEELRAY_TRIANGLE(id, a, b, c);
        a -= place.origin;
        b -= place.origin;
        c -= place.origin;
    }
    float t;
    vec2 uv;
    uint found = peelrayIntersectSheared(r.start, shear, a, b, c, PEELRAY_DECIDES, t, uv);
    float s_hit = t * place.inv_voxel;
#ifdef PEELRAY_PRECISE
    if (PEELRAY_PRECISE && found >= PEELRAY_UNCERTAIN) {
        PEELRAY_TRIANGLE(id, a, b, c);
        const vec2 x = peelrayTwoSum(r.start.x, place.origin.x), y = peelrayTwoSum(r.start.y, place.origin.y),
                   z = peelrayTwoSum(r.start.z, place.origin.z);
        const bool as_given = r.s_shift == 0.0 && place.moved == 0u;
        found = peelrayIntersectPrecise(as_given ? ray.origin : vec3(x.x, y.x, z.x), as_given ? vec3(0) : vec3(x.y, y.y, z.y), r.d, a, b, c, t,
                                        uv) ? PEELRAY_INSIDE : PEELRAY_OUTSIDE;
        s_hit = t * place.inv_voxel;
    }
#endif
    if ((found & PEELRAY_INSIDE) == 0u || !peelrayNearer(r, s_hit, id, hit)) return false;
#ifdef PEELRAY_SHOWN
    if (!PEELRAY_SHOWN(id, peelrayFront(r.d, a, b, c))) return false;
#endif
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

#ifndef PEELRAY_ONLY_PIXELS
#include "peelray/peelray_voxels.glsl"
#endif
#ifndef PEELRAY_ONLY_VOXELS
#include "peelray/peelray_pixels.glsl"
#endif

/// The triangle of an instance that does not count; asked before the ray visits the instance.
uint peelrayOwn(uint instance, uvec2 skip) {
#ifdef PEELRAY_VISIT
    PEELRAY_VISIT(instance);
#endif
    return skip.x == instance ? skip.y : PEELRAY_MISS;
}

/// Nearest hit in one instance's cube, in the order in which the cubes are stored.
void peelrayTraceCube(uint instance, PeelrayRay ray, uint skip, PeelrayOptions options, inout PeelrayHit hit) {
#if defined(PEELRAY_ONLY_VOXELS)
    peelrayTraceVoxels(instance, ray, skip, options, hit);
#elif defined(PEELRAY_ONLY_PIXELS)
    peelrayTracePixels(instance, ray, skip, options, hit);
#else
    if (options.traversal == PEELRAY_VOXELS)
        peelrayTraceVoxels(instance, ray, skip, options, hit);
    else
        peelrayTracePixels(instance, ray, skip, options, hit);
#endif
}

/// Nearest hit in one instance, whether it has a cube or is bare.
void peelrayTraceInstance(uint instance, PeelrayRay ray, uint skip, PeelrayOptions options, inout PeelrayHit hit) {
#ifndef PEELRAY_ONLY_PIXELS
    const PeelrayInstance place = PEELRAY_INSTANCE(instance);
    if (options.traversal == PEELRAY_VOXELS && (place.tops & PEELRAY_BARE) != 0u) {
        peelrayTraceBare(instance, place, ray, skip, hit);
        return;
    }
#endif
    peelrayTraceCube(instance, ray, skip, options, hit);
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
        peelrayTraceInstance(box.instance, ray, peelrayOwn(box.instance, skip), options, hit);
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
    if (options.instances != 0u) {
        uint first = tree.first[0], cubes = options.instances;
        bool done = false;
#ifndef PEELRAY_ONLY_PIXELS
        // Bare bodies first: neighbouring rays do the same there, and what they hit shortens their ways through the cubes.
        for (uint i = 0u; i < options.bare && !done; i++) {
            const PeelrayBox box = PEELRAY_BOX(first + i);
            if (peelrayEnter(box, ray.origin, inv, ray.tmin, hit.t) == PEELRAY_MISS) continue;
            peelrayTraceBare(box.instance, PEELRAY_INSTANCE(box.instance), ray, peelrayOwn(box.instance, skip), hit);
            done = options.any_hit && hit.triangle != PEELRAY_MISS;
        }
        first += options.bare;
        cubes -= options.bare;
#endif
        if (cubes == 1u && !done) {
            const PeelrayBox box = PEELRAY_BOX(first);
            if (box.lower.x <= box.upper.x) peelrayTraceCube(box.instance, ray, peelrayOwn(box.instance, skip), options, hit);
        } else if (cubes > 1u && !done) {
            uint word = peelrayMeet(first, cubes, ray.origin, inv, ray.tmin, hit.t);
            for (; (word >> 24u) != 0u; word = ((word >> 24u) - 1u) << 24u | (word >> 3u & 0x1fffffu)) {
                const PeelrayBox box = PEELRAY_BOX(first + (word & 7u));
                // A hit found in between may lie before it; then it lies before all that are left.
                if (hit.triangle != PEELRAY_MISS && peelrayEnter(box, ray.origin, inv, ray.tmin, hit.t) == PEELRAY_MISS) break;
                peelrayTraceCube(box.instance, ray, peelrayOwn(box.instance, skip), options, hit);
                if (options.any_hit && hit.triangle != PEELRAY_MISS) break;
            }
        }
    } else {
        peelrayTraceTree(tree, ray, inv, skip, options, hit);
    }
    hit.t = hit.triangle == PEELRAY_MISS ? infinity : hit.t * scale;
    return hit;
}

#endif
