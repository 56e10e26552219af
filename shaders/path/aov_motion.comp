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
#include "path/moment_before.glsl"
#include "view/camera.glsl"

/// The motion of a hit.
vec2 motionOf(Hit hit) {
    const vec3 weights = weightsOf(hit);
    vec3 a, b, c;
    placedTriangle(hit.instance, hit.triangle, frame[0].eye, a, b, c);
    const vec3 now = mixed(a, b, c, weights);
    placedBefore(hit.instance, hit.triangle, params.before.first_moving, params.before.eye, a, b, c);
    const vec3 before = mixed(a, b, c, weights);
    const bool orthographic = params.before.orthographic != 0u;
    if (!orthographic && !(product(before, params.before.forward) > params.before.near)) return vec2(0);  // behind the camera
    return placeInPicture(before, params.before.right, params.before.up, params.before.forward, orthographic) -
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
