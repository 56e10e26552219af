// Depths of a shadow map, from the rasterised triangles: each texel's own, on the triangle's plane.
#version 460
#include "common/common.glsl"
#include "common/instance.h"
#include "common/ray.h"
#include "cubemap/cubemap_params.h"
#include "path/frame.h"
layout(local_size_x = 64) in;
PARAMS(MapParams)
BUFFER(readonly, 0, Frame, frame)
BUFFER(readonly, 1, vec3, positions)
BUFFER(readonly, 2, uvec3, triangles)
BUFFER(readonly, 3, SurfaceId, visibility)
BUFFER(writeonly, 4, float, shadow_depths)
BUFFER(readonly, 5, GpuInstance, instances)
#include "common/placed.glsl"

void main() {
    const uint i = GLOBAL_INDEX;
    if (i >= params.size * params.size) return;
    const SurfaceId seen = visibility[i];
    float depth = uintBitsToFloat(0x7f800000u);
    if (seen.triangle != NO_TRIANGLE) {
        const vec2 p = (vec2(i % params.size, i / params.size) + 0.5) * (2.0 / float(params.size)) - 1.0;
        const vec3 offset = frame[0].right * p.x - frame[0].up * p.y, forward = frame[0].forward;
        vec3 a, b, c;
        placedTriangle(seen.instance, seen.triangle, frame[0].eye, a, b, c);
        const vec3 n = cross(b - a, c - a);
        const bool orthographic = frame[0].orthographic != 0u;
        const float facing = dot(n, orthographic ? forward : forward + offset);
        const vec3 depths = vec3(dot(a, forward), dot(b, forward), dot(c, forward));
        const float nearest = min(depths.x, min(depths.y, depths.z)), farthest = max(depths.x, max(depths.y, depths.z));
        // Seen edge-on the plane's depth is any number: the triangle bounds it.
        depth = facing != 0.0 ? clamp(dot(n, orthographic ? a - offset : a) / facing, nearest, farthest) : farthest;
    }
    shadow_depths[params.first + i] = depth;
}
