// What the passes share that find by compute which triangle each pixel of a view sees. A pixel's key is the bits of the depth along
// its ray, then the drawn triangle's number: the least of all is what it sees, whatever the order of the threads.
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#extension GL_EXT_shader_atomic_int64 : require
layout(constant_id = 0) const bool masked = false;  // the scene has masked materials
PARAMS(ViewParams)
BUFFER(readonly, 0, Frame, frame)
BUFFER(readonly, 1, vec3, positions)
BUFFER(readonly, 2, uvec3, triangles)
BUFFER(readonly, 3, GpuInstance, instances)
BUFFER(readonly, 4, GpuDraw, draws)
BUFFER(, 5, uint64_t, visibility)
BUFFER(, 6, uint, queue)
BUFFER(, 7, uvec2, blocks)
#define BASE_COLOR_FIRST_BINDING 8
#include "base_color_buffers.glsl"
#include "alpha_test.glsl"
#include "camera.glsl"
#include "drawn.glsl"
#include "peelray/intersect.glsl"
#include "placed.glsl"

/// Pixels along a side of a tile, and tiles along a side of a block of a large triangle.
const uint VIEW_TILE = 8u, VIEW_BLOCK = 4u;

/// A point relative to the eye as (x, y, w): in the picture at (x, y) / w, in [-1, 1] with y upwards.
vec3 viewPoint(vec3 p) {
    const vec3 right = frame[0].right, up = frame[0].up;
    return vec3(dot(p, right) / dot(right, right), dot(p, up) / dot(up, up), frame[0].orthographic != 0u ? 1.0 : dot(p, frame[0].forward));
}

/// Offers the triangle (relative to the eye) to a pixel: decided by the very ray that will be asked where it hits.
void viewPixel(uint number, SurfaceId surface, vec3 a, vec3 b, vec3 c, uvec2 pixel) {
    const Ray ray = cameraRay(vec2(pixel) + params.jitter);
    if (frame[0].orthographic != 0u) placedTriangle(surface.instance, surface.triangle, ray.origin, a, b, c);
    float t;
    vec2 uv;
    if ((peelrayIntersect(vec3(0), ray.direction, a, b, c, t, uv) & PEELRAY_INSIDE) == 0u || !(t >= 0.0)) return;
    const uint64_t key = packUint2x32(uvec2(number, floatBitsToUint(abs(t))));
    const uint at = pixel.y * frame[0].width + pixel.x;
    if (visibility[at] <= key) return;  // hidden, most likely: no atomic
    if (masked && !alphaPresent(surface.triangle, uv)) return;
    atomicMin(visibility[at], key);
}
