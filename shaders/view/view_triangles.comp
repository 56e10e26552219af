// What each pixel of a view sees, by compute: one thread per drawn triangle. Small ones are offered to their pixels at once, large
// ones are queued in blocks of pixels.
#version 460
#include "common/common.glsl"
#include "common/ray.h"
#include "path/path_params.h"
layout(local_size_x = 256) in;
#include "view/view.glsl"
#include "common/bounds.glsl"
#include "common/last_group.glsl"
#include "common/sidedness.glsl"
#include "view/view_side.glsl"
layout(constant_id = 1) const bool single_sided = false;  // the scene has single-sided materials

/// Triangles whose box holds more pixels are queued.
const uint VIEW_SMALL_PIXELS = 24u;
/// How far rounding may move a corner in the picture, pixels.
const float VIEW_ROUNDING = 1.0 / 16.0;

shared uint group_large;
shared uvec4 large[gl_WorkGroupSize.x];  // number, first entry of the queue; first block and size in blocks, 16 bits each

/// Are all corners beyond the same side of the picture, or behind the eye?
bool viewMisses(vec3 a, vec3 b, vec3 c) {
    const vec3 w = vec3(a.z, b.z, c.z), x = vec3(a.x, b.x, c.x), y = vec3(a.y, b.y, c.y);
    const vec3 beyond_x = w + 1e-5 * (abs(x) + abs(w)), beyond_y = w + 1e-5 * (abs(y) + abs(w));
    return all(greaterThan(x, beyond_x)) || all(greaterThan(-x, beyond_x)) || all(greaterThan(y, beyond_y)) || all(greaterThan(-y, beyond_y)) ||
           all(lessThanEqual(w, vec3(0)));
}

/// The pixels whose samples the triangle may hold; lo > hi: none.
void viewBounds(vec3 a, vec3 b, vec3 c, out ivec2 lo, out ivec2 hi) {
    const ivec2 last = ivec2(frame[0].width, frame[0].height) - 1;
    lo = ivec2(0);
    hi = last;
    // What reaches behind the eye may be anywhere.
    if (min(a.z, min(b.z, c.z)) < frame[0].near && frame[0].orthographic == 0u) return;
    const vec2 p = a.xy / a.z, q = b.xy / b.z, r = c.xy / c.z;
    const vec2 least = min(p, min(q, r)), most = max(p, max(q, r)), scale = 0.5 * vec2(last + 1);
    const vec2 from = vec2(least.x + 1.0, 1.0 - most.y) * scale - params.jitter, to = vec2(most.x + 1.0, 1.0 - least.y) * scale - params.jitter;
    lo = ivec2(ceil(clamp(from - VIEW_ROUNDING, vec2(0), vec2(last + 1))));
    hi = ivec2(floor(clamp(to + VIEW_ROUNDING, vec2(-1), vec2(last))));
}

/// Makes room in the queue for `count` blocks; the first one's place.
uint reserveBlocks(uint count) {
    const uint slot = atomicAdd(queue[QUEUE_VIEW_BLOCKS], count);
    if (slot + count > params.block_capacity) atomicOr(queue[QUEUE_OVERFLOW], OVERFLOW_VIEW);
    return slot;
}

void storeBlock(uint slot, uint number, uvec2 block) {
    if (slot < params.block_capacity) blocks[slot] = uvec2(number, block.x | block.y << 16u);
}

/// Queues the blocks of a large triangle: those that it may touch, or, of many, all in its bounds by the whole workgroup.
void queueBlocks(uint number, ViewEdges edges, ivec2 lo, ivec2 hi) {
    const uvec2 first = uvec2(lo) / VIEW_BLOCK, size = uvec2(hi) / VIEW_BLOCK - first + 1u;
    if (size.x * size.y > 32u) {
        large[atomicAdd(group_large, 1u)] = uvec4(number, reserveBlocks(size.x * size.y), first.x | first.y << 16u, size.x | size.y << 16u);
        return;
    }
    uint touched = 0u;
    for (uint j = 0u; j < size.x * size.y; j++) {
        const vec2 middle = vec2((first + uvec2(j % size.x, j / size.x)) * VIEW_BLOCK) + 0.5 * float(VIEW_BLOCK - 1u) + params.jitter;
        touched |= viewTouches(edges, middle, 0.5 * float(VIEW_BLOCK)) ? 1u << j : 0u;
    }
    if (touched == 0u) return;
    uint slot = reserveBlocks(uint(bitCount(touched)));
    for (; touched != 0u; touched &= touched - 1u) {
        const uint j = uint(findLSB(touched));
        storeBlock(slot++, number, first + uvec2(j % size.x, j / size.x));
    }
}

void main() {
    const uint number = GLOBAL_INDEX, lane = gl_LocalInvocationIndex;
    if (lane == 0u) group_large = 0u;
    barrier();
    vec3 a = vec3(0), b = vec3(0), c = vec3(0);
    ViewEdges edges;
    SurfaceId surface = SurfaceId(0u, 0u);
    ivec2 lo = ivec2(0), hi = ivec2(-1);
    if (number < params.triangles) {
        surface = drawnSurface(number);
        placedTriangle(surface.instance, surface.triangle, frame[0].eye, a, b, c);
        const vec3 p = viewPoint(a), q = viewPoint(b), r = viewPoint(c);
        if (isBounded(p) && isBounded(q) && isBounded(r) && !viewMisses(p, q, r)) viewBounds(p, q, r, lo, hi);
        edges = viewEdges(p, q, r);
        if (single_sided && viewSeesBack(a, b, c, surface.instance) && singleSided(surface.triangle)) hi = lo - 1;
    }
    const ivec2 size = max(hi - lo + 1, ivec2(0));
    if (uint(size.x) * uint(size.y) > VIEW_SMALL_PIXELS) {
        queueBlocks(number, edges, lo, hi);
    } else {
        for (int y = lo.y; y <= hi.y; y++)
            for (int x = lo.x; x <= hi.x; x++)
                if (viewTouches(edges, vec2(x, y) + params.jitter, 0.0)) viewPixel(number, surface, a, b, c, uvec2(x, y));
    }
    barrier();
    for (uint k = 0u; k < group_large; k++) {
        const uvec4 entry = large[k];
        const uvec2 first = uvec2(entry.z & 0xffffu, entry.z >> 16u), count = uvec2(entry.w & 0xffffu, entry.w >> 16u);
        for (uint j = lane; j < count.x * count.y; j += gl_WorkGroupSize.x) storeBlock(entry.y + j, entry.x, first + uvec2(j % count.x, j / count.x));
    }
    if (lane == 0u && isLastGroup()) storeGroups(QUEUE_GROUPS_VIEW, (min(atomicAdd(queue[QUEUE_VIEW_BLOCKS], 0u), params.block_capacity) + VIEW_BLOCKS - 1u) / VIEW_BLOCKS);
}
