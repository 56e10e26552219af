// Refines long lists, one workgroup each: the voxel becomes 4x4x4 finer voxels with lists of their own, in a block of entries behind those of
// the nodes. Its own list stays where it is, unread.
#version 460
#include "ldc/ldc_common.glsl"
layout(local_size_x = 256) in;  // what the pass waits for is its longest list
PARAMS(LdcParams)
BUFFER(readonly, 0, LdcCounters, counters)
BUFFER(, 1, uint, voxel_table)
BUFFER(readonly, 2, uint, voxel_counts)
BUFFER(readonly, 3, uvec2, node_cells)
BUFFER_ALIGNED(, 4, uvec4, patches)
BUFFER_ALIGNED(readonly, 5, LdcCorners, corners)
BUFFER(readonly, 6, LdcBody, bodies)
BUFFER(readonly, 7, uint, refine_queue)
BUFFER(, 8, LdcRefined, refined)
#include "ldc/ldc_corners.glsl"
#define LDC_OWNERS gl_WorkGroupSize.x
#include "ldc/ldc_shared_items.glsl"

// Finer voxels are enlarged by this, in their own units: what LDC_SLACK does for voxels, twice.
const float FINE_SLACK = 8.0 * LDC_SLACK;

shared uint lengths[64], starts[64], filled[64];
// Triangles are taken as many at a time as there are threads, and what they have to do with cells is shared by all threads. Loops are
// small: few groups run this, and code that runs once must be fetched.
shared uint touched[2u * gl_WorkGroupSize.x];  // cells that a thread's triangle touches
shared uint spans[gl_WorkGroupSize.x];         // its bounds in cells: lowest x, y, z, then extents less one, two bits each
// Of the list's first triangles, so that they are not tested twice.
const uint KEPT = 512u;
shared uvec2 kept[KEPT];
shared uint list_samples, list_cells, list_longest, first_fine, occupied[2];

/// The list: of which voxel, and where.
struct LongList {
    uint first, samples;
    vec3 corner;  ///< of its voxel, in finer voxels
    float inv_fine;  ///< finer voxels per unit of the body's space
};

/// A triangle of the list, from the voxel's corner, in finer voxels.
struct FineTriangle {
    vec3 a, b, c, normal;
};

FineTriangle triangleOf(LongList list, uint id) {
    FineTriangle t;
    const LdcCorners packed = corners[id >> 2u];
    ldcCornersOf(packed, t.a, t.b, t.c);
    t.a = t.a * list.inv_fine - list.corner;
    t.b = t.b * list.inv_fine - list.corner;
    t.c = t.c * list.inv_fine - list.corner;
    t.normal = ldcNormalOf(packed);
    return t;
}

/// Does the edge from `a` to `b` separate a square around `centre` from the triangle, as they are seen along an axis? The third corner tells
/// on which side of the edge the triangle is, as in ldcTouches. Written so that a NaN does not.
bool separates(vec2 a, vec2 b, vec2 c, vec2 centre) {
    const vec2 e = b - a, to_c = c - a, to_centre = centre - a;
    const float reach = (0.5 + FINE_SLACK) * (abs(e.x) + abs(e.y));
    const float third = e.x * to_c.y - e.y * to_c.x, f = e.x * to_centre.y - e.y * to_centre.x;
    return f < min(third, 0.0) - reach || f > max(third, 0.0) + reach;
}

bool separated(vec2 a, vec2 b, vec2 c, vec2 centre) {
    return separates(a, b, c, centre) || separates(b, c, a, centre) || separates(c, a, b, centre);
}

/// Does a triangle whose bounds touch the cell touch it? What is left of the separating axes of triangle and box (Akenine-Möller, JGT 2001).
bool touches(FineTriangle t, uvec3 cell) {
    const vec3 centre = vec3(cell) + 0.5, n = t.normal;
    const float reach = (0.5 + FINE_SLACK) * (abs(n.x) + abs(n.y) + abs(n.z));
    return !(abs(dot(n, centre - t.a)) > reach || separated(t.a.xy, t.b.xy, t.c.xy, centre.xy) ||
             separated(t.a.yz, t.b.yz, t.c.yz, centre.yz) || separated(t.a.zx, t.b.zx, t.c.zx, centre.zx));
}

/// Cells that the triangles from `base` on touch, one of each thread, in `touched`. All threads must call.
void touchCells(LongList list, uint base) {
    const uint lane = gl_LocalInvocationIndex, i = base + lane;
    uint cells = 0u;
    touched[2u * lane] = touched[2u * lane + 1u] = 0u;
    if (i < list.samples) {
        const FineTriangle t = triangleOf(list, patches[list.first + i].w);
        const ivec3 low = ivec3(clamp(floor(min(t.a, min(t.b, t.c)) - FINE_SLACK), vec3(0), vec3(3))),
                    high = ivec3(clamp(floor(max(t.a, max(t.b, t.c)) + FINE_SLACK), vec3(0), vec3(3)));
        const uvec3 first = uvec3(low), extent = uvec3(max(high - low, ivec3(0)));
        spans[lane] = first.x | first.y << 2u | first.z << 4u | extent.x << 6u | extent.y << 8u | extent.z << 10u;
        cells = (extent.x + 1u) * (extent.y + 1u) * (extent.z + 1u);
    }
    const uint all = ldcNumberItems(cells);
    for (uint k = lane; k < all; k += gl_WorkGroupSize.x) {
        uint j;
        const uint owner = ldcOwnerOf(k, j), span = spans[owner];
        const uint width = (span >> 6u & 3u) + 1u, height = (span >> 8u & 3u) + 1u, row = j / width;
        const uvec3 cell = (uvec3(span, span >> 2u, span >> 4u) & 3u) + uvec3(j - row * width, row % height, row / height);
        if (!touches(triangleOf(list, patches[list.first + base + owner].w), cell)) continue;
        const uint bit = peelrayIn64(cell);
        atomicOr(touched[2u * owner + (bit >> 5u)], 1u << (bit & 31u));
    }
    barrier();
}

/// The set bit of `mask` before which `rank` others are set.
uint bitOfRank(uvec2 mask, uint rank) {
    const uint low = uint(bitCount(mask.x));
    uint word = rank < low ? mask.x : mask.y, bit = rank < low ? 0u : 32u;
    rank -= rank < low ? 0u : low;
    for (uint width = 16u; width > 0u; width /= 2u) {
        const uint below = uint(bitCount(word & ((1u << width) - 1u)));
        if (rank < below) continue;
        rank -= below;
        word >>= width;
        bit += width;
    }
    return bit;
}

/// How many samples each finer voxel will have, in `lengths`. All threads must call.
void countSamples(LongList list) {
    const uint lane = gl_LocalInvocationIndex;
    for (uint base = 0u; base < list.samples; base += gl_WorkGroupSize.x) {
        touchCells(list, base);
        const uvec2 cells = uvec2(touched[2u * lane], touched[2u * lane + 1u]);
        if (base + lane < KEPT) kept[base + lane] = cells;
        for (uint k = 0u; k < 2u; k++)
            for (uint left = cells[k]; left != 0u; left &= left - 1u) atomicAdd(lengths[k * 32u + uint(findLSB(left))], 1u);
        barrier();
    }
}

/// Writes sample `i` of those that the threads' triangles, which begin at `base`, have.
void writeSample(LongList list, uint base, uint first, uint i) {
    uint rank;
    const uint owner = ldcOwnerOf(i, rank), cell = bitOfRank(uvec2(touched[2u * owner], touched[2u * owner + 1u]), rank);
    const uint id = patches[list.first + base + owner].w, place = atomicAdd(filled[cell], 1u);
    const FineTriangle t = triangleOf(list, id);
    patches[first + starts[cell] + place] = ldcPackPatch(ldcProjectFrom(1.0, t.a, t.b, t.c, t.normal, id & 3u), ldcCell64(cell), id, 0.25,
                                                         PEELRAY_FINE_MARGIN, place + 1u == lengths[cell]);
}

/// Writes the samples of all finer voxels. All threads must call.
void writeSamples(LongList list, uint first) {
    const uint lane = gl_LocalInvocationIndex;
    for (uint base = 0u; base < list.samples; base += gl_WorkGroupSize.x) {
        if (base < KEPT) {
            const uvec2 cells = base + lane < list.samples ? kept[base + lane] : uvec2(0);
            touched[2u * lane] = cells.x;
            touched[2u * lane + 1u] = cells.y;
        } else {
            touchCells(list, base);
        }
        const uint all = ldcNumberItems(ldcMaskCount(uvec2(touched[2u * lane], touched[2u * lane + 1u])));
        for (uint k = lane; k < all; k += gl_WorkGroupSize.x) writeSample(list, base, first, k);
        barrier();
    }
}

void main() {
    const uint lane = gl_LocalInvocationIndex;
    const uint lists = counters[0].refine;
    if (!LDC_FITS(counters[0]) || counters[0].longest <= params.refine_from || lists > params.refine_most ||
        lists > params.refine_capacity || GROUP_INDEX >= lists)
        return;
    const uint voxel = refine_queue[GROUP_INDEX];
    const uint entry_at = params.first_node * 64u + voxel, cell_of_node = node_cells[voxel >> 6u].x;
    LongList list;
    list.first = voxel_table[entry_at] & PEELRAY_FIRST;
    list.samples = voxel_counts[voxel];
    list.corner = vec3((uvec3(cell_of_node & 1023u, cell_of_node >> 10u & 1023u, cell_of_node >> 20u) * 4u + ldcCell64(voxel & 63u)) * 4u);
    list.inv_fine = bodies[node_cells[voxel >> 6u].y].grid.inv_voxel * 4.0;

    if (lane < 64u) lengths[lane] = filled[lane] = 0u;
    if (lane == 0u) list_samples = list_cells = list_longest = occupied[0] = occupied[1] = 0u;
    barrier();

    countSamples(list);

    const uint length = lane < 64u ? lengths[lane] : 0u;
    if (length != 0u) {
        starts[lane] = atomicAdd(list_samples, length);
        atomicAdd(list_cells, 1u);
        atomicMax(list_longest, length);
        atomicOr(occupied[lane >> 5u], 1u << (lane & 31u));
    }
    barrier();

    // What does not come apart (planes that lie upon each other, slivers that cross the whole voxel) stays one list.
    const bool worth = 2u * list_samples <= list.samples * list_cells;
    if (lane == 0u) {
        first_fine = worth ? atomicAdd(refined[0].samples, list_samples) : 0u;
        if (worth) atomicAdd(refined[0].voxels, 1u);
        atomicMax(refined[0].longest, worth ? list_longest : list.samples);
    }
    barrier();
    if (!worth || first_fine + list_samples > params.fine_capacity) return;

    // Behind the samples of the voxels, and behind the nodes.
    const uint first = params.first_sample + counters[0].listed + first_fine;
    const uint block = params.first_node + counters[0].nodes + GROUP_INDEX;
    writeSamples(list, first);
    if (lane < 64u)
        voxel_table[block * 64u + lane] =
            length != 0u ? PEELRAY_OCCUPIED | (first + starts[lane]) : ldcGrowBox(uvec2(occupied[0], occupied[1]), lane);
    if (lane == 0u) voxel_table[entry_at] = PEELRAY_REFINED | block;
}
