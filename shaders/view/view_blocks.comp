// Large triangles of a view: sixteen threads for each block that they may touch, four pixels each.
#version 460
#include "common/common.glsl"
#include "common/ray.h"
#include "path/path_params.h"
layout(local_size_x = 256) in;
#include "view/view.glsl"

void main() {
    const uint threads = gl_WorkGroupSize.x / VIEW_BLOCKS, lane = gl_LocalInvocationIndex % threads;
    const uint entry = GROUP_INDEX * VIEW_BLOCKS + gl_LocalInvocationIndex / threads;
    if (entry >= min(queue[QUEUE_VIEW_BLOCKS], params.block_capacity)) return;
    const uvec2 block = blocks[entry];
    const SurfaceId surface = drawnSurface(block.x);
    vec3 a, b, c;
    placedTriangle(surface.instance, surface.triangle, frame[0].eye, a, b, c);
    const uvec2 corner = uvec2(block.y & 0xffffu, block.y >> 16u) * VIEW_BLOCK;
    const ViewEdges edges = viewEdges(viewPoint(a), viewPoint(b), viewPoint(c));
    for (uint k = 0u; k < VIEW_BLOCK * VIEW_BLOCK / threads; k++) {
        const uint i = k * threads + lane;
        const uvec2 pixel = corner + uvec2(i % VIEW_BLOCK, i / VIEW_BLOCK);
        if (pixel.x >= frame[0].width || pixel.y >= frame[0].height) continue;
        if (viewTouches(edges, vec2(pixel) + params.jitter, 0.0)) viewPixel(block.x, surface, a, b, c, pixel);
    }
}
