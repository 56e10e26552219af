// The paper's traversals (sections 1.3 and 1.4), in the by-pixel order: the three LDIs one after the other, each walked in its own
// plane by a DDA over cells of a hierarchy of depth ranges, down to pixels where the ray's depths meet a cell's. A hit shortens the
// ray for the LDIs that follow. `two_level` has one coarse level, of n x m pixels; `mipmap` all powers of two. Part of peelray.glsl.
#ifndef PEELRAY_PIXELS_GLSL
#define PEELRAY_PIXELS_GLSL

/// A list longer than this is searched for the first depth that matters.
const uint PEELRAY_SHORT_LIST = 8u;

/// Is a sample hit nearer than what has been hit so far? Then that is in `r` and `hit`. `s_plane`: where the ray meets its plane.
bool peelrayTestSample(PeelrayInstance place, PeelrayRay ray, uint skip, PeelrayOptions options, uint j, float w, vec2 slope, float inv_den,
                       float s_plane, float s, float s_out, float low, float high, vec2 centre, float tolerance, vec3 o_pixel, vec3 d, vec3 inv,
                       inout PeelrayLocal r, inout PeelrayHit hit) {
    if (options.hit == PEELRAY_EXACT) {
        // Conservative: as by voxel; half a step of the stored depth and slopes is less than there.
        const float slack = PEELRAY_POSITION_SLACK + PEELRAY_PLANE_SLACK * abs(inv_den);
        if (s_plane < s - slack || s_plane > min(s_out, r.s_best) + slack) return false;
        const uint id = PEELRAY_SAMPLE_ID(j) >> 2u;
        return id != skip && peelrayTestTriangle(place, ray, id, false, peelrayShear(r.d), r, hit);
    }
    float s_hit = s_plane;
    if (options.hit == PEELRAY_TOLERANCE) {
        if (!peelrayTestDepth(r, tolerance, o_pixel, d, inv, w, s_hit)) return false;
    } else {
        const vec2 at = centre + s_plane * d.xy;
        if (!(s_plane > r.s_min && s_plane <= r.s_best && abs(at.x) <= PEELRAY_FOOTPRINT && abs(at.y) <= PEELRAY_FOOTPRINT)) return false;
        // By voxel the sample is met in the voxels that its patch touches, and nowhere else.
        const float extent = PEELRAY_FOOTPRINT * (abs(slope.x) + abs(slope.y)) + PEELRAY_POSITION_SLACK;
        if (high < floor(w - extent) || low > floor(w + extent) + 1.0) return false;
    }
    const uint id = PEELRAY_SAMPLE_ID(j) >> 2u;
    if (id == skip || !peelrayNearer(r, s_hit, id, hit) || !peelraySampleShown(r.d, id)) return false;
    r.s_best = s_hit;
    hit.triangle = id;
    return true;
}

/// The samples [j, end) of a pixel, four layers at a time (the paper, section 4): four loads and four planes in flight.
bool peelrayTestFourByFour(PeelrayInstance place, PeelrayRay ray, uint skip, PeelrayOptions options, uint j, uint end, float s, float s_out,
                           float low, float high, float margin, vec2 centre, float tolerance, vec3 o_pixel, vec3 d, vec3 inv, inout PeelrayLocal r,
                           inout PeelrayHit hit) {
    bool found_one = false;
    for (; j < end; j += 4u) {
        const uint last = end - 1u;
        const uvec2 a = PEELRAY_SAMPLE(j), b = PEELRAY_SAMPLE(min(j + 1u, last)), c = PEELRAY_SAMPLE(min(j + 2u, last)),
                    e = PEELRAY_SAMPLE(min(j + 3u, last));
        const vec4 w = uintBitsToFloat(uvec4(a.x, b.x, c.x, e.x));
        if (w.x > high + margin) break;
        const vec2 sa = unpackSnorm2x16(a.y), sb = unpackSnorm2x16(b.y), sc = unpackSnorm2x16(c.y), se = unpackSnorm2x16(e.y);
        const vec4 su = vec4(sa.x, sb.x, sc.x, se.x) * PEELRAY_SLOPE_RANGE, sv = vec4(sa.y, sb.y, sc.y, se.y) * PEELRAY_SLOPE_RANGE;
        const vec4 inv_den = 1.0 / (d.z - (su * d.x + sv * d.y));
        const vec4 s_plane = (w + (su * centre.x + sv * centre.y) - o_pixel.z) * inv_den;
        const uint count = min(4u, end - j);
        for (uint k = 0u; k < count; k++) {
            PEELRAY_COUNT(samples);
            if (!peelrayTestSample(place, ray, skip, options, j + k, w[k], vec2(su[k], sv[k]), inv_den[k], s_plane[k], s, s_out, low, high, centre,
                                   tolerance, o_pixel, d, inv, r, hit))
                continue;
            found_one = true;
            if (options.any_hit) return true;
        }
    }
    return found_one;
}

/// Hits on the samples of one pixel, while the ray is in its column, from s to s_out. `o`, `d`, `inv` as the LDI sees them.
bool peelrayTestPixel(PeelrayInstance place, PeelrayRay ray, uint skip, PeelrayOptions options, uint list, ivec2 pixel, float tolerance, float s, float s_out,
                      vec3 o, vec3 d, vec3 inv, inout PeelrayLocal r, inout PeelrayHit hit) {
    PEELRAY_COUNT(pixels);
    uint j = PEELRAY_OFFSET(list), end = PEELRAY_OFFSET(list + 1u);
    if (j == end) return false;
    PEELRAY_COUNT(cells);
    const vec3 o_pixel = vec3(o.xy - vec2(pixel), o.z);
    const vec2 centre = o_pixel.xy - 0.5;
    const float w_in = o.z + s * d.z, w_out = o.z + min(s_out, r.s_best) * d.z;
    const float low = min(w_in, w_out), high = max(w_in, w_out);
    // A hit on a sample lies at most this far from its depth: as far as its patch reaches at the steepest slopes.
    const float reach = options.hit == PEELRAY_TOLERANCE ? tolerance
                        : options.hit == PEELRAY_PLANAR  ? 2.0 * PEELRAY_FOOTPRINT * PEELRAY_SLOPE_RANGE + 1.0
                                                         : 1.0;
    const float margin = reach + 2.0 * PEELRAY_POSITION_SLACK;
    if (end - j > PEELRAY_SHORT_LIST) {
        uint last = end;
        while (j < last) {
            const uint middle = (j + last) / 2u;
            if (uintBitsToFloat(PEELRAY_SAMPLE(middle).x) < low - margin)
                j = middle + 1u;
            else
                last = middle;
        }
    }
    if (options.batch == PEELRAY_FOUR_LAYERS)
        return peelrayTestFourByFour(place, ray, skip, options, j, end, s, s_out, low, high, margin, centre, tolerance, o_pixel, d, inv, r, hit);
    bool found_one = false;
    for (; j < end; j++) {
        PEELRAY_COUNT(samples);
        // word 0: w (float); word 1: slopes (2x16 bits: PEELRAY_SLOPE_RANGE)
        const uvec2 data = PEELRAY_SAMPLE(j);
        const float w = uintBitsToFloat(data.x);
        if (w > high + margin) break;
        const vec2 slope = unpackSnorm2x16(data.y) * PEELRAY_SLOPE_RANGE;
        const float inv_den = 1.0 / (d.z - (slope.x * d.x + slope.y * d.y));
        const float s_plane = (w + (slope.x * centre.x + slope.y * centre.y) - o.z) * inv_den;
        if (!peelrayTestSample(place, ray, skip, options, j, w, slope, inv_den, s_plane, s, s_out, low, high, centre, tolerance, o_pixel, d, inv, r, hit)) continue;
        found_one = true;
        if (options.any_hit) break;
    }
    return found_one;
}

/// One LDI as a ray sees it, and where the ray stands in it.
struct PeelrayWalk {
    vec3 o, d, inv;    ///< (u, v, w)
    float tolerance;   ///< of `tolerance` hits, voxels
    ivec2 size;        ///< pixels
    uint first;        ///< its first pixel in the table
    uint level;        ///< of the hierarchy; 0: pixels
    uint top;
    uint level_first;  ///< first range of the level
    float s;
    ivec2 pixel;
    bool done;
};

PeelrayWalk peelrayBeginWalk(PeelrayLocal r, PeelrayOptions options, uint axis, ivec2 size, uint first) {
    PeelrayWalk walk;
    walk.o = peelrayToLdi(r.o, axis);
    walk.d = peelrayToLdi(r.d, axis);
    walk.inv = peelrayToLdi(r.inv, axis);
    walk.tolerance = r.tolerance[axis];
    walk.size = size;
    walk.first = first;
    walk.level_first = first / 2u;
    walk.top = 1u;
    if (options.traversal == PEELRAY_MIPMAP) {
        walk.top = uint(findMSB(max(size.x, size.y) - 1)) + 1u;
        for (uint i = 1u; i < walk.top; i++) {
            const uvec2 cells = peelrayLevelSize(uvec2(size), i);
            walk.level_first += cells.x * cells.y;
        }
    }
    walk.level = walk.top;
    walk.s = r.s_begin;
    walk.pixel = clamp(ivec2(floor(walk.o.xy + walk.s * walk.d.xy)), ivec2(0), size - 1);
    walk.done = !(r.s_begin <= min(r.s_end, r.s_best));
    return walk;
}

/// One step: down a level where the ray's depths meet the cell's range, otherwise on to the next cell. Returns whether
/// a sample was hit.
bool peelrayStep(PeelrayInstance place, PeelrayRay ray, uint skip, PeelrayOptions options, inout PeelrayWalk walk, inout PeelrayLocal r,
                 inout PeelrayHit hit) {
    PEELRAY_COUNT(steps);
    const bool pyramid = options.traversal == PEELRAY_MIPMAP;
    const ivec2 block = ivec2(options.block);
    // The cell of this level that the ray stands in: pixels [lo, hi).
    const ivec2 side = walk.level == 0u ? ivec2(1) : (pyramid ? ivec2(1 << walk.level) : block);
    const ivec2 cell = walk.level == 0u ? walk.pixel : (pyramid ? walk.pixel >> walk.level : walk.pixel / block);
    const ivec2 lo = cell * side, hi = min(lo + side, walk.size);
    const bvec2 up = greaterThanEqual(walk.d.xy, vec2(0));
    const vec2 exits = vec2(up.x ? hi.x : lo.x, up.y ? hi.y : lo.y) * walk.inv.xy - walk.o.xy * walk.inv.xy;
    const float s_out = min(exits.x, exits.y);
    bool found_one = false;
    if (walk.level > 0u) {
        const int cells = pyramid ? int(peelrayLevelSize(uvec2(walk.size), walk.level).x) : (walk.size.x + block.x - 1) / block.x;
        const vec2 range = PEELRAY_RANGE(walk.level_first + uint(cell.y * cells + cell.x));
        const float w_in = walk.o.z + walk.s * walk.d.z, w_out = walk.o.z + min(s_out, min(r.s_end, r.s_best)) * walk.d.z;
        // One voxel more: by voxel a sample is met in all of the voxels that its patch touches (planar).
        const float slack = 2.0 * PEELRAY_POSITION_SLACK + (options.hit == PEELRAY_PLANAR ? 1.0 : 0.0);
        if (max(w_in, w_out) >= range.x - slack && min(w_in, w_out) <= range.y + slack) {
            walk.level--;
            if (pyramid && walk.level > 0u) {
                const uvec2 finer = peelrayLevelSize(uvec2(walk.size), walk.level);
                walk.level_first -= finer.x * finer.y;
            }
            return false;
        }
    } else {
        const uint list = walk.first + peelrayPixelIndex(uvec2(walk.pixel), uint(walk.size.x));
        found_one = peelrayTestPixel(place, ray, skip, options, list, walk.pixel, walk.tolerance, walk.s, s_out, walk.o, walk.d, walk.inv, r, hit);
    }
    walk.done = s_out >= min(r.s_end, r.s_best) || (options.any_hit && found_one);
    if (walk.done) return found_one;
    // On to the next cell, through the exit face; the other coordinate never steps backwards or out of the cell.
    walk.s = max(walk.s, s_out);
    const ivec2 at = ivec2(floor(walk.o.xy + walk.s * walk.d.xy));
    ivec2 next = ivec2(up.x ? min(hi.x - 1, max(walk.pixel.x, at.x)) : max(lo.x, min(walk.pixel.x, at.x)),
                       up.y ? min(hi.y - 1, max(walk.pixel.y, at.y)) : max(lo.y, min(walk.pixel.y, at.y)));
    if (exits.x <= exits.y)
        next.x = up.x ? hi.x : lo.x - 1;
    else
        next.y = up.y ? hi.y : lo.y - 1;
    walk.done = any(lessThan(next, ivec2(0))) || any(greaterThanEqual(next, walk.size));
    // Where it leaves the cell above, the walk goes on there.
    if (!pyramid) {
        if (walk.level == 0u && next / block != walk.pixel / block) walk.level = 1u;
    } else {
        while (walk.level < walk.top && (next >> (walk.level + 1u)) != (walk.pixel >> (walk.level + 1u))) {
            if (walk.level > 0u) {
                const uvec2 finer = peelrayLevelSize(uvec2(walk.size), walk.level);
                walk.level_first += finer.x * finer.y;
            }
            walk.level++;
        }
    }
    walk.pixel = next;
    return found_one;
}

/// As peelrayTraceVoxels, by pixel.
void peelrayTracePixels(uint instance, PeelrayRay ray, uint skip, PeelrayOptions options, inout PeelrayHit hit) {
    const PeelrayInstance place = PEELRAY_INSTANCE(instance);
    PeelrayLocal r;
    if (!peelrayEnterCube(place, ray, hit.t, options, r)) return;
    uint first = place.first_cell;
    bool found_one = false;
    for (uint axis = 0u; axis < 3u; axis++) {
        const ivec2 size = ivec3(peelrayToLdi(vec3(r.last + 1), axis)).xy;
        PeelrayWalk walk = peelrayBeginWalk(r, options, axis, size, first);
        while (!walk.done)
            if (peelrayStep(place, ray, skip, options, walk, r, hit)) found_one = true;
        if (options.any_hit && found_one) break;
        first += uint(size.x * size.y);
    }
    if (found_one) peelrayKeep(r, instance, hit);
}

/// Once for each of four rays k. Written out: spirv-opt unrolls loops without keeping what is declared precise.
#define PEELRAY_EACH_OF_FOUR(statement) \
    {                                   \
        const int k = 0;                \
        statement                       \
    }                                   \
    {                                   \
        const int k = 1;                \
        statement                       \
    }                                   \
    {                                   \
        const int k = 2;                \
        statement                       \
    }                                   \
    {                                   \
        const int k = 3;                \
        statement                       \
    }

/// Four rays at a time (the paper, section 4): in every iteration each of them takes a step. The hits are those of
/// peelrayTrace; the instances are walked in their order, without the hierarchy.
void peelrayTraceFour(uint instances, PeelrayRay rays[4], uvec2 skips[4], PeelrayOptions options, out PeelrayHit hits[4]) {
    const float infinity = uintBitsToFloat(0x7f800000u);
    float scales[4];
    bool valid[4];
    PEELRAY_EACH_OF_FOUR(hits[k] = PeelrayHit(infinity, PEELRAY_MISS, PEELRAY_MISS, vec2(0));
                         valid[k] = peelrayNormalise(rays[k], scales[k]);
                         hits[k].t = rays[k].tmax;)
    for (uint instance = 0u; instance < instances; instance++) {
        const PeelrayInstance place = PEELRAY_INSTANCE(instance);
        PeelrayLocal r[4];
        bool enters[4];
        bool found[4];
        PEELRAY_EACH_OF_FOUR(enters[k] = valid[k] && !(options.any_hit && hits[k].triangle != PEELRAY_MISS) &&
                                         peelrayEnterCube(place, rays[k], hits[k].t, options, r[k]);
                             found[k] = false;)
        uint first = place.first_cell;
        for (uint axis = 0u; axis < 3u; axis++) {
            const uvec3 dims = 16u * peelrayTops(place);
            const ivec2 size = ivec3(peelrayToLdi(vec3(dims), axis)).xy;
            PeelrayWalk walks[4];
            PEELRAY_EACH_OF_FOUR(walks[k].done = true;
                                 if (enters[k] && !(options.any_hit && found[k])) walks[k] = peelrayBeginWalk(r[k], options, axis, size, first);)
            while (!(walks[0].done && walks[1].done && walks[2].done && walks[3].done)) {
                PEELRAY_EACH_OF_FOUR(PEELRAY_COUNT_RAY(k)
                                     if (!walks[k].done && peelrayStep(place, rays[k], skips[k].x == instance ? skips[k].y : PEELRAY_MISS,
                                                                       options, walks[k], r[k], hits[k])) found[k] = true;)
            }
            first += uint(size.x * size.y);
        }
        PEELRAY_EACH_OF_FOUR(if (found[k]) peelrayKeep(r[k], instance, hits[k]);)
    }
    PEELRAY_EACH_OF_FOUR(hits[k].t = hits[k].triangle == PEELRAY_MISS ? infinity : hits[k].t * scales[k];)
}

#endif
