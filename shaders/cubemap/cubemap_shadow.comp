// The baseline's light: lamps and the sun through shadow maps, the diffuse sky unoccluded.
#version 460
#include "common/common.glsl"
#include "common/ray.h"
#include "cubemap/cubemap_params.h"
#include "path/frame.h"
#include "path/path_params.h"
layout(local_size_x = 64) in;
PARAMS(LevelParams)
#define SCENE_FIRST_BINDING 0
#define SCENE_WITH_TRIANGLES
#include "path/scene_buffers.glsl"
BUFFER(readonly, 12, Ray, rays)
BUFFER(readonly, 13, Hit, hits)
BUFFER(, 14, PathNode, nodes)
BUFFER(readonly, 15, GpuLight, lights)
BUFFER(readonly, 16, GpuShadowMap, shadow_maps)
BUFFER(readonly, 17, float, shadow_depths)
#define SHADOW_DEPTH(index) shadow_depths[index]
#include "cubemap/cubemap.glsl"
#include "cubemap/shadow_map.glsl"
#include "path/cone.glsl"
#include "path/frame.glsl"
#include "path/lighting.glsl"

/// Share of the light that arrives from light `index`, which lies in `direction`; `seeps`: on the surface's other side.
float lampShare(uint index, Surface s, SurfaceId from, vec3 direction, bool seeps) {
    if ((frame[0].effects & EFFECT_SHADOW) == 0u) return 1.0;
    if (!seeps && blocksItself(s, from, direction)) return 0.0;
    uint face = 6u * index;
    if (shadow_maps[face + 1u].size != 0u) {
        vec2 unused;
        face += cubeFace(s.shadow_start - lights[index].position, unused);
    }
    return shadowMapShare(shadow_maps[face], seeps ? s.position : s.shadow_start, seeps ? -s.geometric : s.geometric, direction);
}

void main() {
    const uint i = GLOBAL_INDEX;
    if (i >= params.capacity) return;
    const Hit hit = hits[i];
    if (hit.triangle == NO_TRIANGLE) return;
    const vec3 view = -rays[i].direction;
    const Surface s = surfaceAt(hit.instance, hit.triangle, vec2(hit.u, hit.v), -view, coneAt(frame[0].cone, hit.t).x);
    const Material m = materialOf(s);
    if ((m.flags & MATERIAL_UNLIT) != 0u) return;
    const Shade shade = shadeOf(s, m, view);
    vec3 sum, behind;
    skyLight(s, m, shade, view, sum, behind);
    sum += behind;
    for (uint k = 0u; k < frame[0].lights; k++) {
        vec3 direction;
        const vec3 light = lampLight(k, s, m, shade, view, false, vec2(0), direction);
        if (light != vec3(0)) sum += light * lampShare(k, s, SurfaceId(hit.instance, hit.triangle), direction, lightSeeps(s, shade, direction));
    }
    nodes[i].radiance += s.alpha * sum;
}
