// Where the points that the pixels' centres see were in the picture of the moment before: the same places of the same
// triangles, as they stood then, seen by the camera as it stood then.
#version 460
#include "common/common.glsl"
#include "common/ray.h"
#include "path/aov_records.h"
#include "path/frame.h"
#include "path/path_params.h"
#include "common/instance.h"
layout(local_size_x = 64) in;
PARAMS(MotionParams)
BUFFER(readonly, 0, Frame, frame)
BUFFER(readonly, 1, vec3, positions)
BUFFER(readonly, 2, uvec3, triangles)
BUFFER(readonly, 3, GpuInstance, instances)
BUFFER(readonly, 4, Hit, hits)
BUFFER(readonly, 5, vec3, positions_before)  // from first_moving on
BUFFER(readonly, 6, GpuTransform, transforms_before)
BUFFER(writeonly, 7, AovMotion, motions)
#include "common/placed.glsl"
#include "view/camera.glsl"

vec3 positionBefore(uint vertex) {
    return vertex >= params.first_moving ? positions_before[vertex - params.first_moving] : positions[vertex];
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

/// The motion of a hit.
vec2 motionOf(Hit hit) {
    const vec2 uv = clamp(vec2(hit.u, hit.v), vec2(0), vec2(1));  // as surfaceAt does
    const vec3 weights = vec3(max(0.0, 1.0 - uv.x - uv.y), uv);
    vec3 a, b, c;
    placedTriangle(hit.instance, hit.triangle, frame[0].eye, a, b, c);
    const vec3 now = mixed(a, b, c, weights);
    const uvec3 corners = triangles[hit.triangle];
    const GpuTransform to_world = transforms_before[hit.instance];
    a = placedFrom(to_world, positionBefore(corners.x), params.eye);
    b = placedFrom(to_world, positionBefore(corners.y), params.eye);
    c = placedFrom(to_world, positionBefore(corners.z), params.eye);
    const vec3 before = mixed(a, b, c, weights);
    const bool orthographic = params.orthographic != 0u;
    if (!orthographic && !(product(before, params.forward) > params.near)) return vec2(0);  // behind the camera
    return placeInPicture(before, params.right, params.up, params.forward, orthographic) -
           placeInPicture(now, frame[0].right, frame[0].up, frame[0].forward, frame[0].orthographic != 0u);
}

void main() {
    const uint i = GLOBAL_INDEX;
    if (i >= params.capacity) return;
    const uvec2 pixel = recordPixel(i, params.first_row);
    if (pixel.x >= frame[0].width || pixel.y >= frame[0].height) return;
    AovMotion record;
#define AOV_NOTHING(name, type, channels, nothing) record.name = type(nothing);
    MOTION_AOVS(AOV_NOTHING)
    const Hit hit = hits[i];
    if (hit.triangle != NO_TRIANGLE) record.motion = motionOf(hit);
    motions[pixel.y * frame[0].width + pixel.x] = record;
}
