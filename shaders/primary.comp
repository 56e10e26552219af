// Level 0: camera rays of a band and, from the rasterised triangle indices, where they hit.
#version 460
#include "common.glsl"
#include "params.h"
layout(local_size_x = 64) in;
PARAMS(LevelParams)
BUFFER(readonly, 0, Frame, frame)
BUFFER(readonly, 1, vec3, positions)
BUFFER(readonly, 2, uvec3, triangles)
BUFFER(readonly, 3, SurfaceId, visibility)
BUFFER(writeonly, 4, Ray, rays)
BUFFER(writeonly, 5, RayState, states)
BUFFER(writeonly, 6, Hit, hits)
BUFFER(writeonly, 7, uint, queue)
BUFFER(readonly, 8, GpuInstance, instances)
#include "peelray/intersect.glsl"
#include "camera.glsl"
#include "placed.glsl"
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
    if (inside) seen = visibility[pixel.y * frame[0].width + pixel.x];
    if (seen.triangle != NO_TRIANGLE) {
        vec3 a, b, c;
        placedTriangle(seen.instance, seen.triangle, ray.origin, a, b, c);
        float t;
        vec2 uv;
        const uint found = peelrayIntersect(vec3(0), ray.direction, a, b, c, t, uv);
        if ((found & PEELRAY_INSIDE) == 0u) {
            // The rasteriser snaps corners to a 256th of a pixel: this ray just misses. The nearest point of the triangle's
            // plane stands in, moved back into the triangle.
            const vec3 n = cross(b - a, c - a);
            const float facing = dot(n, ray.direction);
            t = facing != 0.0 ? dot(n, a) / facing : 0.0;
            const vec3 p = ray.direction * t - a;
            const float scale = 1.0 / dot(n, n);
            uv = clamp(vec2(dot(cross(p, c - a), n), dot(cross(b - a, p), n)) * scale, vec2(0), vec2(1));
            uv /= max(1.0, uv.x + uv.y);
            t = max(0.0, dot(a + (b - a) * uv.x + (c - a) * uv.y, ray.direction));
        }
        hit = Hit(t, seen.triangle, seen.instance, uv.x, uv.y);
    }
    hits[i] = hit;
}
