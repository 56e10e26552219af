// Level 0: camera rays of a band and, from the triangles that its pixels see, where they hit.
#version 460
#include "common.glsl"
#include "params.h"
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
BUFFER(writeonly, 7, uint, queue)
BUFFER(readonly, 8, GpuInstance, instances)
BUFFER(readonly, 9, GpuDraw, draws)
#include "camera.glsl"
#include "camera_hit.glsl"
#include "seen.glsl"
#include "shading.glsl"

void main() {
    const uint i = GLOBAL_INDEX;
    if (i == 0u) queue[0] = params.capacity;
    if (i >= params.capacity) return;
    const uvec2 pixel = recordPixel(i, params.first_row);
    const Ray ray = cameraRay(vec2(pixel) + params.jitter);
    rays[i] = ray;
    states[i] = RayState(vec3(1), MEDIUM_NONE | RAY_SEES_SUN, hash3(uvec3(pixel, 0u)).x);
    Hit hit = Hit(uintBitsToFloat(0x7f800000u), NO_TRIANGLE, 0u, 0.0, 0.0);
    const bool inside = pixel.x < frame[0].width && pixel.y < frame[0].height;
    SurfaceId seen = SurfaceId(0u, NO_TRIANGLE);
    if (inside) seen = seenAt(pixel, by_number);
    if (seen.triangle != NO_TRIANGLE) hit = cameraHit(ray, seen);
    hits[i] = hit;
}
