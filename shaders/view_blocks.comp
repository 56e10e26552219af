// Large triangles of a view: one workgroup per block of 4x4 tiles, which leaves out the tiles that the triangle does not touch.
#version 460
#include "common.glsl"
#include "params.h"
layout(local_size_x = 256) in;
#include "view.glsl"

const uint PIXELS = VIEW_TILE * VIEW_TILE;

shared uint group_tiles;
shared uint tiles[VIEW_BLOCK * VIEW_BLOCK];  // of the block, that the triangle may touch

/// May rays through the tile's pixels hit the triangle? An edge's function of the place in the picture is linear, its sign says the side,
/// whether the triangle reaches behind the eye or not (Olano, Greer: Triangle Scan Conversion Using 2D Homogeneous Coordinates,
/// 1997); their sum is of the sign of the side that the eye sees.
bool viewTouches(vec3 a, vec3 b, vec3 c, uvec2 tile) {
    const vec3 u = cross(c, b), v = cross(a, c), w = cross(b, a), sum = u + v + w;
    const vec2 pixel = 2.0 / vec2(frame[0].width, frame[0].height);
    const vec2 middle = (vec2(tile * VIEW_TILE) + 0.5 * float(VIEW_TILE - 1u) + params.jitter) * pixel;
    const vec3 at = vec3(middle.x - 1.0, 1.0 - middle.y, 1.0);
    const vec2 half_side = 0.5 * float(VIEW_TILE) * pixel;
    const float size = max(dot(a, a), max(dot(b, b), dot(c, c)));
    const vec4 values = vec4(dot(u, at), dot(v, at), dot(w, at), dot(sum, at));
    const vec4 reach = half_side.x * abs(vec4(u.x, v.x, w.x, sum.x)) + half_side.y * abs(vec4(u.y, v.y, w.y, sum.y)) + 4e-6 * size;
    return !any(lessThan(values + reach, vec4(0))) || !any(greaterThan(values - reach, vec4(0)));
}

void main() {
    if (GROUP_INDEX >= min(queue[QUEUE_VIEW_BLOCKS], params.block_capacity)) return;
    const uint lane = gl_LocalInvocationIndex;
    if (lane == 0u) group_tiles = 0u;
    barrier();
    const uvec2 block = blocks[GROUP_INDEX];
    const SurfaceId surface = drawnSurface(block.x);
    vec3 a, b, c;
    placedTriangle(surface.instance, surface.triangle, frame[0].eye, a, b, c);
    if (lane < VIEW_BLOCK * VIEW_BLOCK) {
        const uvec2 tile = uvec2(block.y & 0xffffu, block.y >> 16u) + uvec2(lane % VIEW_BLOCK, lane / VIEW_BLOCK);
        if (tile.x * VIEW_TILE < frame[0].width && tile.y * VIEW_TILE < frame[0].height && viewTouches(viewPoint(a), viewPoint(b), viewPoint(c), tile))
            tiles[atomicAdd(group_tiles, 1u)] = tile.x | tile.y << 16u;
    }
    barrier();
    for (uint k = lane / PIXELS; k < group_tiles; k += gl_WorkGroupSize.x / PIXELS) {
        const uvec2 pixel = uvec2(tiles[k] & 0xffffu, tiles[k] >> 16u) * VIEW_TILE + uvec2(lane % VIEW_TILE, lane / VIEW_TILE % VIEW_TILE);
        if (pixel.x < frame[0].width && pixel.y < frame[0].height) viewPixel(block.x, surface, a, b, c, pixel);
    }
}
