// Where what the denoiser is guided by was in the picture of the moment before. One pass a level, before that level's denoise_guides: what
// a way meets last holds. Seen in mirrors or through glass, it is the image of the point as it stood then: the way is straightened at each
// surface as that stood then, which is exact for flat mirrors.
#version 460
#include "common/common.glsl"
#include "common/instance.h"
#include "common/ray.h"
#include "denoise/denoise_params.h"
#include "path/frame.h"
#include "path/path_params.h"
#include "view/view_params.h"
layout(local_size_x = 64) in;
layout(constant_id = 0) const bool camera = false;         // level 0
layout(constant_id = 1) const bool by_number = false;      // see seen.glsl
layout(constant_id = 2) const bool kept = false;           // this level's rays and hits are in buffers
layout(constant_id = 3) const bool incoming_kept = false;  // and so are those of the level before
PARAMS(DenoiseMotionParams)
BUFFER(readonly, 0, Frame, frame)
BUFFER(readonly, 1, vec3, positions)
BUFFER(readonly, 2, uvec3, triangles)
BUFFER(readonly, 3, GpuInstance, instances)
BUFFER(readonly, 4, vec3, positions_before)  // from first_moving on
BUFFER(readonly, 5, GpuTransform, transforms_before)
BUFFER(readonly, 6, uint, triangle_objects)
BUFFER(readonly, 7, Ray, rays)
BUFFER(readonly, 8, Hit, hits)
BUFFER(readonly, 9, Ray, incoming_rays)
BUFFER(readonly, 10, Hit, incoming_hits)
BUFFER(readonly, 11, uvec2, visibility)
BUFFER(readonly, 12, GpuDraw, draws)
BUFFER(readonly, 13, uint, queue)
BUFFER(readonly, 14, DenoiseLink, denoise_links)
BUFFER(, 15, DenoiseImage, denoise_images)
BUFFER(writeonly, 16, DenoiseMotion, denoise_motions)
#include "view/camera.glsl"
#include "view/camera_hit.glsl"
#include "view/seen.glsl"
#include "path/moment_before.glsl"

const DenoiseMotion kNoMotion = DenoiseMotion(vec2(0), 0.0, DENOISE_NO_OBJECT);

/// What the camera sees at a pixel.
Hit seenFromCamera(uvec2 pixel, Ray ray) {
    const SurfaceId seen = seenAt(pixel, by_number);
    if (seen.triangle == NO_TRIANGLE) return Hit(uintBitsToFloat(0x7f800000u), NO_TRIANGLE, 0u, 0.0, 0.0);
    return cameraHit(ray, seen);
}

/// A vector that is fixed to a triangle, after the triangle has moved from a, b, c to d, e, f: turned as its first edge and its normal
/// are.
vec3 carried(vec3 v, vec3 a, vec3 b, vec3 c, vec3 d, vec3 e, vec3 f) {
    const vec3 n = cross(b - a, c - a), m = cross(e - d, f - d);
    if (dot(n, n) <= 0.0 || dot(m, m) <= 0.0) return v;
    const vec3 x = normalize(b - a), z = normalize(n), along = normalize(e - d), up = normalize(m);
    return dot(v, x) * along + dot(v, cross(z, x)) * cross(up, along) + dot(v, z) * up;
}

mat3 outer(vec3 a, vec3 b) { return mat3(a * b.x, a * b.y, a * b.z); }

/// What turns a way behind a surface into the straight continuation of the way ahead of it: a mirror's reflection or, where it goes
/// through, a rotation.
mat3 straightened(vec3 ahead, vec3 behind, bool through) {
    const mat3 identity = mat3(1);
    if (!through) {
        const vec3 n = normalize(behind - ahead);
        return identity - 2.0 * outer(n, n);
    }
    const vec3 sum = ahead + behind;
    return identity - outer(sum, sum) / (1.0 + dot(ahead, behind)) + 2.0 * outer(ahead, behind);
}

/// The image by one surface more: the one that `incoming` met, if `direction` is how the way goes on from there.
DenoiseImage straightened(DenoiseImage image, Ray incoming, Hit hit, vec3 direction) {
    vec3 a, b, c, d, e, f;
    placedTriangle(hit.instance, hit.triangle, frame[0].eye, a, b, c);
    const vec3 side = cross(b - a, c - a), ahead = normalize(incoming.direction), behind = normalize(direction);
    const bool through = dot(side, ahead) * dot(side, behind) >= 0.0;
    if (through && dot(ahead, behind) > 1.0 - 1e-6) return image;
    placedBefore(hit.instance, hit.triangle, params.before.first_moving, params.before.eye, d, e, f);
    const mat3 linear = mat3(image.x, image.y, image.z),
               turn = straightened(carried(ahead, a, b, c, d, e, f), carried(behind, a, b, c, d, e, f), through),
               both = linear * turn;
    const vec3 point = mixed(d, e, f, weightsOf(hit));
    return DenoiseImage(both[0], both[1], both[2], image.origin + linear * (point - turn * point), image.place);
}

/// `point`: where the camera sees the hit now, relative to its eye.
DenoiseMotion motionOf(Hit hit, DenoiseImage image, vec3 point) {
    vec3 a, b, c;
    placedBefore(hit.instance, hit.triangle, params.before.first_moving, params.before.eye, a, b, c);
    vec3 before = mixed(a, b, c, weightsOf(hit));
    if (!camera) before = mat3(image.x, image.y, image.z) * before + image.origin;
    const bool orthographic = params.before.orthographic != 0u;
    const float ahead = product(before, params.before.forward);
    if (!orthographic && !(ahead > params.before.near)) return kNoMotion;
    const vec2 motion = placeInPicture(before, params.before.right, params.before.up, params.before.forward, orthographic) -
                        placeInPicture(point, frame[0].right, frame[0].up, frame[0].forward, frame[0].orthographic != 0u);
    const uint object = instances[hit.instance].info.first_object + triangle_objects[hit.triangle];
    return DenoiseMotion(vec2(motion.x, -motion.y), orthographic ? ahead : length(before), object);
}

void main() {
    const uint i = GLOBAL_INDEX;
    if (i >= params.capacity || queue[QUEUE_OVERFLOW] != 0u) return;
    const uvec2 pixel = recordPixel(i, params.first_row);
    if (pixel.x >= frame[0].width || pixel.y >= frame[0].height) return;
    const uint at = pixel.y * frame[0].width + pixel.x;
    DenoiseLink link = DenoiseLink(vec3(1), 0.0, i);
    if (!camera) link = denoise_links[i];
    if (link.place >= params.level_capacity) return;
    const Ray first = cameraRay(vec2(pixel) + params.jitter);
    Ray ray = first;
    if (kept) ray = rays[link.place];
    Hit hit;
    if (kept)
        hit = hits[link.place];
    else
        hit = seenFromCamera(pixel, first);
    DenoiseImage image = DenoiseImage(vec3(1, 0, 0), vec3(0, 1, 0), vec3(0, 0, 1), vec3(0), i);
    if (!camera) {
        image = denoise_images[i];
        if (incoming_kept)
            image = straightened(image, incoming_rays[image.place], incoming_hits[image.place], ray.direction);
        else
            image = straightened(image, first, seenFromCamera(pixel, first), ray.direction);
        image.place = link.place;
    }
    denoise_images[i] = image;
    if (hit.triangle == NO_TRIANGLE) {
        denoise_motions[at] = kNoMotion;
        return;
    }
    vec3 point;
    if (camera) {
        vec3 a, b, c;
        placedTriangle(hit.instance, hit.triangle, frame[0].eye, a, b, c);
        point = mixed(a, b, c, weightsOf(hit));
    } else {
        point = first.origin - frame[0].eye + first.direction * (link.depth + hit.t);
    }
    denoise_motions[at] = motionOf(hit, image, point);
}
