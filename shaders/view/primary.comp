// Camera rays of a band and, from the triangles that its pixels see, where they hit: for the passes that want them in buffers. The
// frame itself does without (scatter.comp).
#version 460
#include "common/common.glsl"
#include "common/instance.h"
#include "common/ray.h"
#include "path/frame.h"
#include "path/path_params.h"
#include "view/view_params.h"
layout(local_size_x = 64) in;
layout(constant_id = 0) const bool by_number = false;  // see seen.glsl
PARAMS(LevelParams)
BUFFER(readonly, 0, Frame, frame)
BUFFER(readonly, 1, vec3, positions)
BUFFER(readonly, 2, uvec3, triangles)
BUFFER(readonly, 3, uvec2, visibility)
BUFFER(writeonly, 4, Ray, rays)
BUFFER(writeonly, 5, RayState, states)
BUFFER(writeonly, 6, Hit, hits)
BUFFER(readonly, 7, GpuInstance, instances)
BUFFER(readonly, 8, GpuDraw, draws)
#include "view/camera.glsl"
#include "view/camera_hit.glsl"
#include "view/seen.glsl"
#include "path/shading.glsl"
#include "view/camera_start.glsl"

void main() {
    const uint i = GLOBAL_INDEX;
    if (i >= params.capacity) return;
    Ray ray;
    RayState state;
    Hit hit;
    cameraStart(recordPixel(i, params.first_row), params.jitter, by_number, ray, state, hit);
    rays[i] = ray;
    states[i] = state;
    hits[i] = hit;
}
