// Adds what a band's rays cost to the sums of its pixels; not if a queue overflowed, since then the band is rendered
// again.
#version 460
#include "common/common.glsl"
#include "path/frame.h"
#include "path/path_params.h"
layout(local_size_x = 64) in;
PARAMS(LevelParams)
BUFFER(readonly, 0, Frame, frame)
BUFFER(readonly, 1, PeelrayCounts, costs)
BUFFER(readonly, 2, uint, queue)
BUFFER(, 3, PeelrayCounts, pixel_costs)
#include "view/camera.glsl"
#include "path/cost_sums.glsl"

void main() {
    const uint i = GLOBAL_INDEX;
    if (i >= params.capacity || queue[QUEUE_OVERFLOW] != 0u) return;
    const uvec2 pixel = recordPixel(i, params.first_row);
    if (pixel.x >= frame[0].width || pixel.y >= frame[0].height) return;
    const uint at = pixel.y * frame[0].width + pixel.x;
    pixel_costs[at] = costSum(pixel_costs[at], costs[i]);
}
