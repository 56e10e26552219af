// Traversal by voxel, the part of peelray.glsl that includes it.
//
// A cube is walked as an irregular grid (Pérard-Gayot, Kalojanov, Slusallek, Eurographics 2017) on cells that rasterisation made: every
// empty cell knows an empty box around it, which a ray leaves in one step.
#ifndef PEELRAY_VOXELS_GLSL
#define PEELRAY_VOXELS_GLSL

/// What the samples of a list are tested with.
struct PeelraySegment {
    vec3 enters, leaves;  ///< where the ray enters and leaves their cell, from the cell's centre, voxels
    float parts;          ///< of a cell's side, of which coverage knows four, per voxel
    float uncertain;      ///< a plane's values at both ends must differ by more for the coverage to count
};

/// `exact`: may the ray hit the triangle of this sample inside the cell? Conservative: the sample's plane passes between the
/// segment's ends, and the triangle is in the part of the pixel where the ray meets it.
bool peelrayMayHit(uvec4 data, PeelraySegment segment) {
    // The plane's normal along x, y (word 0) and z (low half of word 1): half floats, 1 along its LDI's axis; its distance from the
    // cell's centre along that axis (word 2: a float whose lowest bit ends the list); coverage (high half of word 1: 4x4 cells of
    // the pixel); triangle id * 4 + axis (word 3).
    const vec3 normal = vec3(unpackHalf2x16(data.x), unpackHalf2x16(data.y).x);
    const float w = uintBitsToFloat(data.z);
    const float f0 = dot(normal, segment.enters) - w, f1 = dot(normal, segment.leaves) - w;
    // Written so that a NaN passes.
    if (min(f0, f1) > PEELRAY_SEGMENT_SLACK || max(f0, f1) < -PEELRAY_SEGMENT_SLACK) return false;
    if (!(abs(f0 - f1) > segment.uncertain)) return true;
    const vec3 at = mix(segment.enters, segment.leaves, clamp(f0 / (f0 - f1), 0.0, 1.0));
    const uint axis = data.w & 3u;
    const vec2 pixel = axis == 0u ? at.yz : (axis == 1u ? at.zx : at.xy);
    const uvec2 bit = uvec2(clamp(pixel * segment.parts + 2.0, vec2(0), vec2(3)));
    return (data.y >> (16u + bit.y * 4u + bit.x) & 1u) != 0u;
}

/// The mirrored space in which a ray goes up along every axis, where cells are walked: mirrored coordinates are ~coordinate.
struct PeelrayMirror {
    bvec3 up;    ///< the ray goes up anyway
    ivec3 flip;  ///< what coordinates are xor-ed with
    uint upper;  ///< of a packed box, the bits of those ends that the ray leaves through
};

PeelrayMirror peelrayMirror(vec3 direction) {
    const bvec3 up = greaterThanEqual(direction, vec3(0));
    return PeelrayMirror(up, ivec3(up.x ? 0 : -1, up.y ? 0 : -1, up.z ? 0 : -1),
                         (up.x ? 3u : 0u) | (up.y ? 12u : 0u) | (up.z ? 48u : 0u));
}

/// What stands at a cell: a list of samples, or an empty box. Cells are voxels, or where some voxels are refined the finer ones.
struct PeelrayCell {
    ivec3 last;  ///< the box's last cell along the ray, mirrored
    bool more;   ///< the list has samples left
    bool fine;   ///< it is that of a finer voxel
    uint j;      ///< its next sample
};

/// `at`: the cell; `refined`, a constant: cells are finer voxels; `top_entry`: of the 16x16x16 voxels that it is in.
PeelrayCell peelrayCellAt(uvec2 top_entry, uvec3 at, bool refined, PeelrayMirror mirror) {
    const int fine = refined ? 2 : 0;
    PeelrayCell cell;
    cell.more = false;
    cell.fine = false;
    cell.j = 0u;
    if ((top_entry.x >> 31u) == 0u) {
        const uvec3 word = uvec3(mirror.up.x ? top_entry.y : top_entry.x, mirror.up.y ? top_entry.y : top_entry.x,
                                 mirror.up.z ? top_entry.y : top_entry.x);
        cell.last = (ivec3(word.x & 1023u, word.y >> 10u & 1023u, word.z >> 20u & 1023u) << (4 + fine) ^ mirror.flip) | ((16 << fine) - 1);
        return cell;
    }
    uint entry = PEELRAY_NODE(top_entry.y << 6u | peelrayIn64(at >> (2 + fine)));
    int scale = 2 + fine;
    if ((entry >> 31u) != 0u) {
        entry = PEELRAY_VOXEL(entry << 6u | peelrayIn64(at >> fine));
        scale = fine;
        if (refined && entry >= PEELRAY_REFINED) {
            entry = PEELRAY_VOXEL(entry << 6u | peelrayIn64(at));
            scale = 0;
            cell.fine = true;
        }
        cell.more = (entry >> 31u) != 0u;
        cell.j = entry & PEELRAY_FIRST;
    }
    const int own = refined ? (1 << scale) - 1 : 0, inside = cell.more ? own : (4 << scale) - 1;
    const uint ends = (entry >> 6u & mirror.upper) | (entry & ~mirror.upper);
    const uvec3 end = cell.more ? uvec3(0) : (uvec3(ends, ends >> 2u, ends >> 4u) & 3u) << scale;
    cell.last = (((ivec3(at) & ~inside) | ivec3(end)) ^ mirror.flip) | ((1 << scale) - 1);
    return cell;
}

/// The ray's way through the cell `at`, from `s` to `s_out`.
PeelraySegment peelrayWayThrough(PeelrayLocal r, uvec3 at, PeelrayCell cell, bool refined, float s, float s_out) {
    PeelraySegment way;
    way.parts = cell.fine ? 16.0 : 4.0;
    way.uncertain = cell.fine ? PEELRAY_FINE_UNCERTAIN_PLACE : PEELRAY_UNCERTAIN_PLACE;
    const vec3 centre = !refined ? vec3(at) + 0.5
                        : cell.fine ? vec3(at) * 0.25 + 0.125
                                    : vec3(at & ~3u) * 0.25 + 0.5;
    const vec3 from_centre = r.o - centre;
    way.enters = from_centre + s * r.d;
    way.leaves = from_centre + min(s_out, r.s_best) * r.d;
    return way;
}

/// Tests the list from sample `j` on for `exact` hits; `found_one` becomes true with one. `segment`: the ray's way through the cell;
/// `next`: that sample, but where PEELRAY_DEFER.
void peelrayTestTriangles(PeelrayInstance place, PeelrayRay ray, uint skip, PeelrayOptions options, PeelraySegment segment, PeelrayShear shear,
                          uint j, uvec4 next, inout PeelrayLocal r, inout PeelrayHit hit, inout bool found_one) {
    bool more = true;
    // Triangles may be tested together after the samples of neighbouring rays: PEELRAY_DEFER.
    do {
        uint candidate = PEELRAY_MISS;
        while (more && candidate == PEELRAY_MISS && !(options.any_hit && found_one)) {
            PEELRAY_COUNT(samples);
            const uvec4 data = PEELRAY_DEFER ? PEELRAY_PATCH(j) : next;
            more = (data.z & 1u) == 0u;
            j++;
            // Under way while this one is tested.
            if (!PEELRAY_DEFER && more) next = PEELRAY_PATCH(j);
            if (peelrayMayHit(data, segment)) {
                const uint id = data.w >> 2u;
                if (id != skip) {
                    if (PEELRAY_DEFER)
                        candidate = id;
                    else if (peelrayTestTriangle(place, ray, id, true, shear, r, hit))
                        found_one = true;
                }
            }
        }
        if (PEELRAY_DEFER && candidate != PEELRAY_MISS && peelrayTestTriangle(place, ray, candidate, true, shear, r, hit)) found_one = true;
    } while (PEELRAY_DEFER && more && !(options.any_hit && found_one));
}

/// `tolerance`: does the ray pass this sample of the cell `at` nearly enough, at `s_hit`?
bool peelrayHitsDepth(uvec2 data, PeelrayLocal r, uvec3 at, out float s_hit) {
    // Word 0: the depth in the cell, a float; word 1: axis (bits 0 and 1), last of its list (bit 31).
    const uint axis = data.y & 3u;
    const float w = uintBitsToFloat(data.x);
    return peelrayTestDepth(r, r.tolerance[axis], peelrayToLdi(r.o - vec3(at), axis), peelrayToLdi(r.d, axis), peelrayToLdi(r.inv, axis), w,
                            s_hit);
}

/// `planar`: does the ray meet this sample's plane inside its footprint, at `s_hit`? `from_centre`: the ray's origin from the cell's.
bool peelrayHitsPlane(uvec2 data, PeelrayLocal r, vec3 from_centre, out float s_hit) {
    // The plane's normal along x, y (word 0) and z (low half of word 1): half floats, 1 along its LDI's axis and nowhere else; its
    // distance from the cell's centre along that axis (bits 16 to 30: [-2.5, 2.5] voxels); last of its list (bit 31).
    const vec3 normal = vec3(unpackHalf2x16(data.x), unpackHalf2x16(data.y).x);
    const float w = float(data.y >> 16u & 0x7fffu) * (5.0 / 32767.0) - 2.5;
    s_hit = (w - dot(normal, from_centre)) / dot(normal, r.d);
    // The footprint is one of pixels: along the axis it has no bounds.
    const vec3 place_in_cell = abs(from_centre + s_hit * r.d);
    return s_hit > r.s_min && s_hit <= r.s_best && (place_in_cell.x <= PEELRAY_FOOTPRINT || normal.x == 1.0) &&
           (place_in_cell.y <= PEELRAY_FOOTPRINT || normal.y == 1.0) && (place_in_cell.z <= PEELRAY_FOOTPRINT || normal.z == 1.0);
}

/// Tests the list from sample `j` on for hits of samples: `planar` or `tolerance`.
void peelrayTestSamples(uint skip, PeelrayOptions options, uvec3 at, uint j, inout PeelrayLocal r, inout PeelrayHit hit,
                        inout bool found_one) {
    const vec3 from_centre = r.o - (vec3(at) + 0.5);
    bool more = true;
    while (more) {
        PEELRAY_COUNT(samples);
        const uvec2 data = PEELRAY_SAMPLE(j);
        float s_hit;
        if (options.hit == PEELRAY_TOLERANCE ? peelrayHitsDepth(data, r, at, s_hit) : peelrayHitsPlane(data, r, from_centre, s_hit)) {
            const uint id = PEELRAY_SAMPLE_ID(j) >> 2u;
            if (id != skip && peelrayNearer(r, s_hit, id, hit) && peelraySampleShown(r.d, id)) {
                r.s_best = s_hit;
                hit.triangle = id;
                found_one = true;
            }
        }
        more = (data.y >> 31u) == 0u;
        j++;
    }
}

/// The entry of the table of 16x16x16 voxels, of which there are `tops` along each axis.
uvec2 peelrayTopAt(PeelrayInstance place, uvec3 tops, uvec3 top) {
    return PEELRAY_TOP(place.first_cell + (top.z * tops.y + top.y) * tops.x + top.x);
}

/// Where the ray is after a box up to the cell `last`, which it leaves at `s`: through the exit face; the other coordinates come from the
/// position but never step backwards or out of the box.
ivec3 peelrayNextCell(PeelrayLocal r, ivec3 cell, ivec3 last, vec3 exits, float s, float cells_per_voxel, PeelrayMirror mirror) {
    ivec3 next = clamp(ivec3(floor((r.o + s * r.d) * cells_per_voxel)) ^ mirror.flip, cell, last);
    if (exits.x <= exits.y && exits.x <= exits.z)
        next.x = last.x + 1;
    else if (exits.y <= exits.z)
        next.y = last.y + 1;
    else
        next.z = last.z + 1;
    return next;
}

/// Nearest hit of a ray in one instance's cube, by voxel, with tmin < t < hit.t replaces `hit`; with any_hit: some hit. The ray is
/// valid (peelrayTrace), `skip` a triangle that does not count.
void peelrayTraceVoxels(uint instance, PeelrayRay ray, uint skip, PeelrayOptions options, inout PeelrayHit hit) {
    const PeelrayInstance place = PEELRAY_INSTANCE(instance);
    PeelrayLocal r;
    if (!peelrayEnterCube(place, ray, hit.t, options, r)) return;
    const bool refined = options.refined && options.hit == PEELRAY_EXACT;
    const int fine = refined ? 2 : 0;
    const float cells_per_voxel = refined ? 4.0 : 1.0, voxels_per_cell = refined ? 0.25 : 1.0;  // powers of two round nothing
    const uvec3 tops = uvec3(r.last + 1) >> 4u;
    const PeelrayMirror mirror = peelrayMirror(r.d);
    const vec3 o_inv = r.o * r.inv, per_cell = abs(r.inv) * voxels_per_cell;
    const PeelrayShear shear = peelrayShear(r.d);
    const ivec3 last = ((r.last + 1) << fine) - 1;
    float s = r.s_begin;
    ivec3 cell = clamp(ivec3(floor((r.o + s * r.d) * cells_per_voxel)), ivec3(0), last) ^ mirror.flip;
    const ivec3 beyond = ivec3(mirror.up.x ? last.x + 1 : 0, mirror.up.y ? last.y + 1 : 0, mirror.up.z ? last.z + 1 : 0);
    bool found_one = false;
    uvec2 top_entry = peelrayTopAt(place, tops, uvec3(cell ^ mirror.flip) >> (4 + fine));

    // In an order that hides what loads take: a list's first sample is under way while the exits are computed, the next cell's entry while
    // samples are tested.
    while (true) {
        PEELRAY_COUNT(steps);
        const uvec3 at = uvec3(cell ^ mirror.flip);
        const PeelrayCell here = peelrayCellAt(top_entry, at, refined, mirror);
        uvec4 first_sample = uvec4(0);
        if (!PEELRAY_DEFER && options.hit == PEELRAY_EXACT && here.more) first_sample = PEELRAY_PATCH(here.j);
        const vec3 exits = vec3(here.last + 1) * per_cell - o_inv;
        const float s_out = min(exits.x, min(exits.y, exits.z));
        cell = peelrayNextCell(r, cell, here.last, exits, max(s, s_out), cells_per_voxel, mirror);
        const bool outside = any(equal(cell, beyond));
        if (!outside) top_entry = peelrayTopAt(place, tops, uvec3(cell ^ mirror.flip) >> (4 + fine));
        if (here.more) {
            PEELRAY_COUNT(cells);
            if (options.hit == PEELRAY_EXACT)
                peelrayTestTriangles(place, ray, skip, options, peelrayWayThrough(r, at, here, refined, s, s_out), shear, here.j, first_sample,
                                     r, hit, found_one);
            else
                peelrayTestSamples(skip, options, at, here.j, r, hit, found_one);
            if (options.any_hit && found_one) break;
        }
        if (s_out >= min(r.s_end, r.s_best) || outside) break;
        s = max(s, s_out);
    }
    if (found_one) peelrayKeep(r, instance, hit);
}

/// The same in a body that has no cube (PEELRAY_BARE), triangle by triangle. The ray meets its box.
void peelrayTraceBare(uint instance, PeelrayInstance place, PeelrayRay ray, uint skip, inout PeelrayHit hit) {
    PeelrayLocal r;
    const float scale = peelrayIntoBody(place, ray, r);
    // The cube that it does not have is as good a measure of what is far.
    const vec3 size = vec3(peelrayTops(place)) * (16.0 * place.voxel), away = abs(r.start);
    if (!(max(away.x, max(away.y, away.z)) <= PEELRAY_NEAR_SIZES * max(size.x, max(size.y, size.z)))) {
        const float enters = peelrayClip(r.start, peelrayInverse(r.d), size).x * scale;
        const float along = min(max(ray.tmin, enters - 1e-6 * abs(enters)), hit.t);
        r.s_shift = along * r.s_per_t;
        r.start = peelrayStartAt(place, ray, along);
    }
    r.s_min = ray.tmin * r.s_per_t - r.s_shift;
    r.s_best = hit.t * r.s_per_t - r.s_shift;
    const PeelrayShear shear = peelrayShear(r.d);
    const uint first = place.first_cell & 0x3fffffffu, last = first + (place.first_cell >> 30u);
    bool found_one = false;
    for (uint id = first; id <= last; id++)
        if (id != skip && peelrayTestTriangle(place, ray, id, false, shear, r, hit)) found_one = true;
    if (found_one) peelrayKeep(r, instance, hit);
}

#endif
