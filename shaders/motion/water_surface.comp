// The vertices of a water surface in this moment.
#version 460
#include "common/common.glsl"
#include "motion/motion_params.h"
layout(local_size_x = 64) in;
PARAMS(WaterParams)
BUFFER(readonly, 0, float, heights)
BUFFER(readonly, 1, float, velocities)
BUFFER(writeonly, 2, vec3, positions)
BUFFER(writeonly, 3, vec3, normals)
BUFFER(, 4, uvec3, body_lower)
BUFFER(, 5, uvec3, body_upper)
#include "common/grow_bounds.glsl"
#include "motion/water.glsl"

void main() {
    const uint row = params.cells + 1u, i = GLOBAL_INDEX;
    const bool valid = i < row * row;
    vec3 position = vec3(0);
    if (valid) {
        const uint x = i % row, z = i / row;
        const float spacing = params.size / float(params.cells);
        const uint x0 = max(x, 1u) - 1u, x1 = min(x + 1u, params.cells), z0 = max(z, 1u) - 1u, z1 = min(z + 1u, params.cells);
        position = vec3(params.size * (float(x) / float(params.cells) - 0.5), waterHeight(x, z), params.size * (float(z) / float(params.cells) - 0.5));
        positions[params.first_vertex + i] = position;
        normals[params.first_vertex + i] = normalize(vec3((waterHeight(x0, z) - waterHeight(x1, z)) / (float(x1 - x0) * spacing), 1,
                                                          (waterHeight(x, z0) - waterHeight(x, z1)) / (float(z1 - z0) * spacing)));
    }
    growBounds(params.body, position, valid);
}
