// Auxiliary pictures of what the camera sees at the pixel centres (aov_table.h).
#version 460
#include "common/common.glsl"
#include "common/ray.h"
#include "path/aov_records.h"
#include "path/path_params.h"
layout(local_size_x = 64) in;
PARAMS(LevelParams)
#define SCENE_FIRST_BINDING 0
#define SCENE_WITH_TRIANGLES
#include "path/scene_buffers.glsl"
BUFFER(readonly, 12, Ray, rays)
BUFFER(readonly, 13, Hit, hits)
BUFFER(writeonly, 14, AovSurface, aovs)
BUFFER(readonly, 15, uint, triangle_ids)
BUFFER(readonly, 16, uint, triangle_objects)
#include "path/cone.glsl"
#include "path/frame.glsl"
#include "view/camera.glsl"

void main() {
    const uint i = GLOBAL_INDEX;
    if (i >= params.capacity) return;
    const uvec2 pixel = recordPixel(i, params.first_row);
    if (pixel.x >= frame[0].width || pixel.y >= frame[0].height) return;
    AovSurface record;
#define AOV_NOTHING(name, type, channels, nothing) record.name = type(nothing);
    SEEN_AOVS(AOV_NOTHING)
    const Hit hit = hits[i];
    if (hit.triangle != NO_TRIANGLE) {
        const Surface s = surfaceAt(hit.instance, hit.triangle, vec2(hit.u, hit.v), rays[i].direction, coneAt(frame[0].cone, hit.t).x);
        record.depth = hit.t;
        record.normal = vec4(s.normal, 0);
        record.albedo = vec4(s.base_color, 1);
        record.position = vec4(s.position, 1);
        record.triangle = float(instances[hit.instance].info.first_id + triangle_ids[hit.triangle]);
        record.instance = float(instances[hit.instance].info.first_object + triangle_objects[hit.triangle]);
        record.material = float(s.material);
    }
    aovs[pixel.y * frame[0].width + pixel.x] = record;
}
