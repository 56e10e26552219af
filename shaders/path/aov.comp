// Auxiliary pictures of what the camera sees at the pixel centres: per pixel one vec4 each of (depth, triangle, material, hit),
// normal, base colour, position.
#version 460
#include "common/common.glsl"
#include "common/ray.h"
#include "path/path_params.h"
layout(local_size_x = 64) in;
PARAMS(LevelParams)
#define SCENE_FIRST_BINDING 0
#define SCENE_WITH_TRIANGLES
#include "path/scene_buffers.glsl"
BUFFER(readonly, 12, Ray, rays)
BUFFER(readonly, 13, Hit, hits)
BUFFER(writeonly, 14, vec4, aovs)
BUFFER(readonly, 15, uint, triangle_ids)
#include "path/frame.glsl"
#include "view/camera.glsl"

void main() {
    const uint i = GLOBAL_INDEX;
    if (i >= params.capacity) return;
    const uvec2 pixel = recordPixel(i, params.first_row);
    if (pixel.x >= frame[0].width || pixel.y >= frame[0].height) return;
    const uint at = (pixel.y * frame[0].width + pixel.x) * 4u;
    const Hit hit = hits[i];
    const float infinity = uintBitsToFloat(0x7f800000u);
    vec4 ids = vec4(infinity, -1, -1, 0), normal = vec4(0), color = vec4(0), position = vec4(0);
    if (hit.triangle != NO_TRIANGLE) {
        const Surface s = surfaceAt(hit.instance, hit.triangle, vec2(hit.u, hit.v), rays[i].direction);
        ids = vec4(hit.t, float(instances[hit.instance].info.first_id + triangle_ids[hit.triangle]), float(s.material), 1);
        normal = vec4(s.normal, 0);
        color = vec4(s.base_color, 1);
        position = vec4(s.position, 1);
    }
    aovs[at] = ids;
    aovs[at + 1u] = normal;
    aovs[at + 2u] = color;
    aovs[at + 3u] = position;
}
