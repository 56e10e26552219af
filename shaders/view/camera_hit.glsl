// Where a camera ray hits the triangle that was rasterised. Include after the buffers positions, triangles and instances.
#ifndef PEELRAY_CAMERA_HIT_GLSL
#define PEELRAY_CAMERA_HIT_GLSL

#include "common/ray.h"

#include "peelray/intersect.glsl"
#include "common/placed.glsl"

Hit cameraHit(Ray ray, SurfaceId seen) {
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
    return Hit(t, seen.triangle, seen.instance, uv.x, uv.y);
}

#endif
