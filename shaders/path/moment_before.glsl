// Points of the triangles as they stood at the moment before, and where a camera sees points. Include after the buffers frame, positions,
// triangles, instances, positions_before and transforms_before, and after placed.glsl.
#ifndef PEELRAY_MOMENT_BEFORE_GLSL
#define PEELRAY_MOMENT_BEFORE_GLSL

#include "common/ray.h"

/// `first_moving`: from this vertex on there are positions_before.
vec3 positionBefore(uint vertex, uint first_moving) {
    return vertex >= first_moving ? positions_before[vertex - first_moving] : positions[vertex];
}

/// The corners of a triangle of an instance at the moment before, relative to `from`.
void placedBefore(uint instance, uint triangle, uint first_moving, vec3 from, out vec3 a, out vec3 b, out vec3 c) {
    const uvec3 corners = triangles[triangle];
    const GpuTransform to_world = transforms_before[instance];
    a = placedFrom(to_world, positionBefore(corners.x, first_moving), from);
    b = placedFrom(to_world, positionBefore(corners.y, first_moving), from);
    c = placedFrom(to_world, positionBefore(corners.z, first_moving), from);
}

/// Weights of the corners, as surfaceAt has them.
vec3 weightsOf(Hit hit) {
    const vec2 uv = clamp(vec2(hit.u, hit.v), vec2(0), vec2(1));
    return vec3(max(0.0, 1.0 - uv.x - uv.y), uv);
}

vec3 mixed(vec3 a, vec3 b, vec3 c, vec3 weights) {
    precise vec3 p = a * weights.x + b * weights.y + c * weights.z;
    return p;
}

float product(vec3 a, vec3 b) {
    precise float sum = a.x * b.x + a.y * b.y + a.z * b.z;
    return sum;
}

/// Where a point, relative to the eye, is in the picture: pixels from its middle, right and up. Precise, so that what
/// stands still before a still camera has not moved at all.
vec2 placeInPicture(vec3 p, vec3 right, vec3 up, vec3 forward, bool orthographic) {
    precise vec2 place = vec2(product(p, right) / product(right, right), product(p, up) / product(up, up));
    if (!orthographic) place = place / product(p, forward);
    precise vec2 pixels = 0.5 * place * vec2(frame[0].width, frame[0].height);
    return pixels;
}

#endif
