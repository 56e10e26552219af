// What the passes share that find by compute which triangle each pixel of a view sees. A pixel's key is the bits of the depth along
// its ray, then the drawn triangle's number: the least of all is what it sees, whatever the order of the threads.
#include "common/instance.h"
#include "common/ray.h"
#include "path/frame.h"
#include "view/view_params.h"
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
#include "common/base_color_buffers.glsl"
#include "common/material.glsl"
#include "view/camera.glsl"
#include "view/drawn.glsl"
#include "peelray/intersect.glsl"
#include "common/placed.glsl"

/// Pixels along a side of a block of a large triangle, and blocks that a workgroup looks at.
const uint VIEW_BLOCK = 8u, VIEW_BLOCKS = 16u;

/// A point relative to the eye as (x, y, w): in the picture at (x, y) / w, in [-1, 1] with y upwards.
vec3 viewPoint(vec3 p) {
    const vec3 right = frame[0].right, up = frame[0].up;
    return vec3(dot(p, right) / dot(right, right), dot(p, up) / dot(up, up), frame[0].orthographic != 0u ? 1.0 : dot(p, frame[0].forward));
}

/// The edges' functions of the place in the picture, which are linear: their signs say the side, whether the triangle reaches behind the
/// eye or not (Olano, Greer: Triangle Scan Conversion Using 2D Homogeneous Coordinates, 1997); `sum`: of all three, of the sign of the
/// side that the eye sees.
struct ViewEdges {
    vec3 u, v, w, sum;
    float rounding;
};

/// Of a triangle in the picture (viewPoint).
ViewEdges viewEdges(vec3 a, vec3 b, vec3 c) {
    const vec3 u = cross(c, b), v = cross(a, c), w = cross(b, a);
    return ViewEdges(u, v, w, u + v + w, 4e-6 * max(dot(a, a), max(dot(b, b), dot(c, c))));
}

/// May rays through the pixels within `half_side` pixels of `middle` hit the triangle?
bool viewTouches(ViewEdges edges, vec2 middle, float half_side) {
    const vec2 pixel = 2.0 / vec2(frame[0].width, frame[0].height);
    const vec3 at = vec3(middle.x * pixel.x - 1.0, 1.0 - middle.y * pixel.y, 1.0);
    const vec4 values = vec4(dot(edges.u, at), dot(edges.v, at), dot(edges.w, at), dot(edges.sum, at));
    const vec4 reach = half_side * (pixel.x * abs(vec4(edges.u.x, edges.v.x, edges.w.x, edges.sum.x)) +
                                    pixel.y * abs(vec4(edges.u.y, edges.v.y, edges.w.y, edges.sum.y))) + edges.rounding;
    return !any(lessThan(values + reach, vec4(0))) || !any(greaterThan(values - reach, vec4(0)));
}

/// Offers the triangle (relative to the eye) to a pixel: decided by the very ray that will be asked where it hits.
void viewPixel(uint number, SurfaceId surface, vec3 a, vec3 b, vec3 c, uvec2 pixel) {
    const Ray ray = cameraRay(vec2(pixel) + params.jitter);
    if (frame[0].orthographic != 0u) placedTriangle(surface.instance, surface.triangle, ray.origin, a, b, c);
    float t;
    vec2 uv;
    if (peelrayIntersectSheared(vec3(0), peelrayShear(ray.direction), a, b, c, false, t, uv) == PEELRAY_OUTSIDE || !(t >= 0.0)) return;
    const uint64_t key = packUint2x32(uvec2(number, floatBitsToUint(abs(t))));
    const uint at = pixel.y * frame[0].width + pixel.x;
    if (visibility[at] <= key) return;  // hidden, most likely: no atomic
    if (masked && !alphaPresent(surface.triangle, uv)) return;
    atomicMin(visibility[at], key);
}
