// The paper's traversals (sections 1.3 and 1.4), in the by-pixel order: the three LDIs one after the other, each walked in its own
// plane by a DDA over cells of a hierarchy of depth ranges, down to pixels where the ray's depths meet a cell's. A hit shortens the
// ray for the LDIs that follow. `two_level` has one coarse level, of n x m pixels; `mipmap` all powers of two. Part of peelray.glsl.
#ifndef PEELRAY_PIXELS_GLSL
#define PEELRAY_PIXELS_GLSL

/// A list longer than this is searched for the first depth that matters.
const uint PEELRAY_SHORT_LIST = 8u;

/// Hits on the samples of one pixel, while the ray is in its column, from s to s_out. `o`, `d`, `inv` as the LDI sees them.
bool peelrayTestPixel(PeelrayInstance place, PeelrayRay ray, uint skip, PeelrayOptions options, uint list, ivec2 pixel, float s, float s_out,
                      vec3 o, vec3 d, vec3 inv, inout PeelrayLocal r, inout PeelrayHit hit) {
    uint j = PEELRAY_OFFSET(list), end = PEELRAY_OFFSET(list + 1u);
    if (j == end) return false;
    PEELRAY_COUNT(y);
    const vec3 o_pixel = vec3(o.xy - vec2(pixel), o.z);
    const vec2 centre = o_pixel.xy - 0.5;
    const float w_in = o.z + s * d.z, w_out = o.z + min(s_out, r.s_best) * d.z;
    const float low = min(w_in, w_out), high = max(w_in, w_out);
    // A hit on a sample lies at most this far from its depth: as far as its patch reaches at the steepest slopes.
    const float reach = options.hit == PEELRAY_TOLERANCE ? r.tolerance
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
    bool found_one = false;
    for (; j < end; j++) {
        PEELRAY_COUNT(z);
        // word 0: w (float); word 1: slopes (2x16 bits: PEELRAY_SLOPE_RANGE)
        const uvec2 data = PEELRAY_SAMPLE(j);
        const float w = uintBitsToFloat(data.x);
        if (w > high + margin) break;
        if (options.hit == PEELRAY_TOLERANCE) {
            float s_near;
            if (!peelrayTestDepth(r, o_pixel, d, inv, w, s_near)) continue;
            const uint id = PEELRAY_SAMPLE_ID(j) >> 2u;
            if (id == skip) continue;
            r.s_best = s_near;
            hit.triangle = id;
        } else {
            const vec2 slope = unpackSnorm2x16(data.y) * PEELRAY_SLOPE_RANGE;
            const float inv_den = 1.0 / (d.z - dot(slope, d.xy));
            const float s_plane = (w + dot(slope, centre) - o.z) * inv_den;
            if (options.hit == PEELRAY_PLANAR) {
                const vec2 at = centre + s_plane * d.xy;
                if (!(s_plane > r.s_min && s_plane < r.s_best && abs(at.x) <= PEELRAY_FOOTPRINT && abs(at.y) <= PEELRAY_FOOTPRINT)) continue;
                // By voxel the sample is met in the voxels that its patch touches, and nowhere else.
                const float extent = PEELRAY_FOOTPRINT * (abs(slope.x) + abs(slope.y)) + PEELRAY_POSITION_SLACK;
                if (high < floor(w - extent) || low > floor(w + extent) + 1.0) continue;
                const uint id = PEELRAY_SAMPLE_ID(j) >> 2u;
                if (id == skip) continue;
                r.s_best = s_plane;
                hit.triangle = id;
            } else {
                // Conservative: as by voxel; half a step of the stored depth and slopes is less than there.
                const float slack = PEELRAY_POSITION_SLACK + PEELRAY_PLANE_SLACK * abs(inv_den);
                if (s_plane < s - slack || s_plane > min(s_out, r.s_best) + slack) continue;
                const uint id = PEELRAY_SAMPLE_ID(j) >> 2u;
                if (id == skip || !peelrayTestTriangle(place, ray, id, r, hit)) continue;
            }
        }
        found_one = true;
        if (options.any_hit) break;
    }
    return found_one;
}

/// Nearest hit of a ray in one LDI, which is `size` pixels large and begins at pixel `first` of the table.
bool peelrayWalkImage(PeelrayInstance place, PeelrayRay ray, uint skip, PeelrayOptions options, uint axis, ivec2 size, uint first,
                      inout PeelrayLocal r, inout PeelrayHit hit) {
    const bool pyramid = options.traversal == PEELRAY_MIPMAP;
    const vec3 o = peelrayToImage(r.o, axis), d = peelrayToImage(r.d, axis), inv = peelrayToImage(r.inv, axis);
    const bvec2 up = greaterThanEqual(d.xy, vec2(0));
    const vec2 o_inv = o.xy * inv.xy;
    const ivec2 block = ivec2(options.block);
    const uint top = pyramid ? uint(findMSB(max(size.x, size.y) - 1)) + 1u : 1u;
    uint level = top, level_first = first / 2u;
    if (pyramid)
        for (uint i = 1u; i < top; i++) {
            const uvec2 cells = peelrayLevelSize(uvec2(size), i);
            level_first += cells.x * cells.y;
        }
    float s = r.s_begin;
    ivec2 pixel = clamp(ivec2(floor(o.xy + s * d.xy)), ivec2(0), size - 1);
    bool found_one = false;
    while (true) {
        PEELRAY_COUNT(x);
        // The cell of this level that the ray stands in: pixels [lo, hi).
        const ivec2 side = level == 0u ? ivec2(1) : (pyramid ? ivec2(1 << level) : block);
        const ivec2 cell = level == 0u ? pixel : (pyramid ? pixel >> level : pixel / block);
        const ivec2 lo = cell * side, hi = min(lo + side, size);
        const vec2 exits = vec2(up.x ? hi.x : lo.x, up.y ? hi.y : lo.y) * inv.xy - o_inv;
        const float s_out = min(exits.x, exits.y);
        if (level > 0u) {
            const int cells = pyramid ? int(peelrayLevelSize(uvec2(size), level).x) : (size.x + block.x - 1) / block.x;
            const vec2 range = PEELRAY_RANGE(level_first + uint(cell.y * cells + cell.x));
            const float w_in = o.z + s * d.z, w_out = o.z + min(s_out, min(r.s_end, r.s_best)) * d.z;
            // One voxel more: by voxel a sample is met in all of the voxels that its patch touches (planar).
            const float slack = 2.0 * PEELRAY_POSITION_SLACK + (options.hit == PEELRAY_PLANAR ? 1.0 : 0.0);
            if (max(w_in, w_out) >= range.x - slack && min(w_in, w_out) <= range.y + slack) {
                level--;
                if (pyramid && level > 0u) {
                    const uvec2 finer = peelrayLevelSize(uvec2(size), level);
                    level_first -= finer.x * finer.y;
                }
                continue;
            }
        } else if (peelrayTestPixel(place, ray, skip, options, first + peelrayPixelIndex(uvec2(pixel), uint(size.x)), pixel, s, s_out, o, d, inv, r,
                                    hit)) {
            found_one = true;
            if (options.any_hit) break;
        }
        if (s_out >= min(r.s_end, r.s_best)) break;
        // On to the next cell, through the exit face; the other coordinate never steps backwards or out of the cell.
        s = max(s, s_out);
        const ivec2 at = ivec2(floor(o.xy + s * d.xy));
        ivec2 next = ivec2(up.x ? min(hi.x - 1, max(pixel.x, at.x)) : max(lo.x, min(pixel.x, at.x)),
                           up.y ? min(hi.y - 1, max(pixel.y, at.y)) : max(lo.y, min(pixel.y, at.y)));
        if (exits.x <= exits.y)
            next.x = up.x ? hi.x : lo.x - 1;
        else
            next.y = up.y ? hi.y : lo.y - 1;
        if (any(lessThan(next, ivec2(0))) || any(greaterThanEqual(next, size))) break;
        // Where it leaves the cell above, the walk goes on there.
        if (!pyramid) {
            if (level == 0u && next / block != pixel / block) level = 1u;
        } else {
            while (level < top && (next >> (level + 1u)) != (pixel >> (level + 1u))) {
                if (level > 0u) {
                    const uvec2 finer = peelrayLevelSize(uvec2(size), level);
                    level_first += finer.x * finer.y;
                }
                level++;
            }
        }
        pixel = next;
    }
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
        const ivec2 size = ivec3(peelrayToImage(vec3(r.last + 1), axis)).xy;
        if (r.s_begin <= min(r.s_end, r.s_best) && peelrayWalkImage(place, ray, skip, options, axis, size, first, r, hit)) {
            found_one = true;
            if (options.any_hit) break;
        }
        first += uint(size.x * size.y);
    }
    if (found_one) {
        hit.t = (r.s_best + r.s_shift) / r.s_per_t;
        hit.instance = instance;
    }
}

#endif
