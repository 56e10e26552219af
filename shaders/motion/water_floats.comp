// Where floating bodies are: on the mean height and slope of the water under them.
#version 460
#include "common/common.glsl"
#include "common/instance.h"
#include "motion/motion_params.h"
layout(local_size_x = 64) in;
PARAMS(WaterParams)
BUFFER(readonly, 0, float, heights)
BUFFER(readonly, 1, float, velocities)
BUFFER(readonly, 2, GpuFloat, floats)
BUFFER(writeonly, 3, GpuTransform, transforms)
#include "motion/water.glsl"

void main() {
    if (GLOBAL_INDEX >= params.floats) return;
    const GpuFloat f = floats[GLOBAL_INDEX];
    float mean = waterHeight(f.at);
    vec2 slope = vec2(0);
    for (uint i = 0u; i < 8u; i++) {
        const float angle = float(i) * 0.78539816;
        const vec2 arm = 0.7 * f.radius * vec2(cos(angle), sin(angle));
        const float height = waterHeight(f.at + arm);
        mean += height;
        slope += height * arm;
    }
    mean /= 9.0;
    slope /= 4.0 * 0.49 * f.radius * f.radius;  // the sum of the arms' squares in each direction
    const vec3 up = normalize(vec3(-slope.x, 1, -slope.y)), ahead = vec3(cos(f.turned), 0, sin(f.turned));
    const vec3 x = normalize(ahead - up * dot(ahead, up));
    transforms[f.instance] = GpuTransform(mat3(x, up, cross(x, up)), vec3(f.at.x, mean, f.at.y));
}
