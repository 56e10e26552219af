// One step of the wave equation on a grid of heights (Water of src/scene/generated.h): velocities first, then heights.
#version 460
#include "common/common.glsl"
#include "motion/motion_params.h"
layout(local_size_x = 64) in;
PARAMS(WaterParams)
BUFFER(readonly, 0, float, heights)
BUFFER(, 1, float, velocities)
BUFFER(writeonly, 2, float, next_heights)

void main() {
    const uint row = params.cells + 1u, i = GLOBAL_INDEX;
    if (i >= row * row) return;
    const uint x = i % row, z = i / row;
    // Beyond a wall the water is as high as at it: waves come back.
    const float around = heights[x > 0u ? i - 1u : i] + heights[x < params.cells ? i + 1u : i] + heights[z > 0u ? i - row : i] +
                         heights[z < params.cells ? i + row : i];
    float velocity = velocities[i];
    if (params.drop_strength != 0.0) {
        const vec2 p = vec2(x, z) * (params.size / float(params.cells)) - 0.5 * params.size - params.drop_at;
        const float q = dot(p, p) / (2.0 * params.drop_width * params.drop_width);
        velocity += params.drop_strength * (1.0 - q) * exp(-q);
    }
    velocity += params.step * (params.stiffness * (around - 4.0 * heights[i]) - params.damping * velocity);
    velocities[i] = velocity;
    next_heights[i] = heights[i] + params.step * velocity;
}
