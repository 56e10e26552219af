// Where the tree of rays begins: a pixel's camera ray and what it hits. Include after camera.glsl, camera_hit.glsl, seen.glsl and
// shading.glsl.
#ifndef PEELRAY_CAMERA_START_GLSL
#define PEELRAY_CAMERA_START_GLSL

#include "common/ray.h"
#include "path/cone.glsl"
#include "path/path_params.h"
#include "path/random.glsl"

/// `by_number`: see seenAt().
void cameraStart(uvec2 pixel, vec2 jitter, bool by_number, out Ray ray, out RayState state, out Hit hit) {
    ray = cameraRay(vec2(pixel) + jitter);
    state = RayState(vec3(1), MEDIUM_NONE | RAY_SEES_SUN, pixelSeed(pixel), packCone(frame[0].cone), 0.0, 0u);
    hit = Hit(uintBitsToFloat(0x7f800000u), NO_TRIANGLE, 0u, 0.0, 0.0);
    if (pixel.x >= frame[0].width || pixel.y >= frame[0].height) return;
    const SurfaceId seen = seenAt(pixel, by_number);
    if (seen.triangle != NO_TRIANGLE) hit = cameraHit(ray, seen);
}

#endif
