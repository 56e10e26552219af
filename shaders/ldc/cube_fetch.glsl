// The cubes' buffers as the traversal's fetches; include before peelray/peelray.glsl. Bindings FIRST to FIRST + 9, FIRST + 48 to 50.
#include "common/instance.h"
#include "ldc/ldc_params.h"
#include "peelray/ray.glsl"
#ifndef CUBE_FIRST_BINDING
#define CUBE_FIRST_BINDING 0
#endif
BUFFER_ALIGNED(readonly, CUBE_FIRST_BINDING + 0, uvec2, top_table)
BUFFER(readonly, CUBE_FIRST_BINDING + 1, uint, node_table)
BUFFER(readonly, CUBE_FIRST_BINDING + 2, uint, voxel_table)
BUFFER_ALIGNED(readonly, CUBE_FIRST_BINDING + 3, uvec2, samples)
BUFFER(readonly, CUBE_FIRST_BINDING + 4, uint, sample_ids)
#ifndef PEELRAY_ONLY_PIXELS
#include "ldc/ldc_corners.glsl"
BUFFER_ALIGNED(readonly, CUBE_FIRST_BINDING + 48, uvec4, patches)
BUFFER_ALIGNED(readonly, CUBE_FIRST_BINDING + 49, LdcCorners, corners)
layout(constant_id = 19) const bool merging = false;  // some instances' triangles have copies, which share a cube
BUFFER_ALIGNED(readonly, CUBE_FIRST_BINDING + 50, uvec2, copied)  // of each copy: instance and triangle
#endif
BUFFER(readonly, CUBE_FIRST_BINDING + 5, vec3, positions)
BUFFER(readonly, CUBE_FIRST_BINDING + 6, uvec3, triangles)
BUFFER(readonly, CUBE_FIRST_BINDING + 7, GpuInstance, instances)
BUFFER_ALIGNED(readonly, CUBE_FIRST_BINDING + 8, PeelrayBox, instance_boxes)
BUFFER_ALIGNED(readonly, CUBE_FIRST_BINDING + 9, PeelrayInstance, instance_cubes)

#define PEELRAY_INSTANCE(i) instance_cubes[i]
#define PEELRAY_BOX(i) instance_boxes[i]
#define PEELRAY_TOP(i) top_table[i]
#define PEELRAY_NODE(i) node_table[i]
#define PEELRAY_VOXEL(i) voxel_table[i]
#define PEELRAY_SAMPLE(i) samples[i]
#define PEELRAY_SAMPLE_ID(i) sample_ids[i]
#define PEELRAY_PATCH(i) patches[i]
// By pixel the same bindings hold the offsets of the pixels and the ranges of the coarse levels.
#define PEELRAY_OFFSET(i) node_table[i]
#define PEELRAY_RANGE(i) uintBitsToFloat(uvec2(voxel_table[2u * (i)], voxel_table[2u * (i) + 1u]))

void cubeTriangle(uint id, out vec3 a, out vec3 b, out vec3 c) {
    const uvec3 corners = triangles[id];
    a = positions[corners.x];
    b = positions[corners.y];
    c = positions[corners.z];
}
#define PEELRAY_TRIANGLE(id, a, b, c) cubeTriangle(id, a, b, c)
#define PEELRAY_CORNERS(id, a, b, c) ldcCornersOf(corners[id], a, b, c)

#ifdef PEELRAY_ONLY_PIXELS
#define cubeSurface(instance, triangle) uvec2(instance, triangle)
#else
/// The instance and the triangle of a hit, as everybody else knows them.
uvec2 cubeSurface(uint instance, uint triangle) {
    return merging && triangle != PEELRAY_MISS && triangle >= params.first_copy ? copied[triangle - params.first_copy] : uvec2(instance, triangle);
}
#endif

/// Barycentric weights (second and third corner) of a hit at `p` on a sample: of the nearest point of the triangle's plane, moved
/// into the triangle.
vec2 cubeWeights(uint instance, uint triangle, vec3 p) {
    vec3 a, b, c;
    cubeTriangle(triangle, a, b, c);
    const GpuTransform to_world = instances[instance].to_world;
    a = to_world.linear * a + to_world.position;
    b = to_world.linear * b + to_world.position;
    c = to_world.linear * c + to_world.position;
    const vec3 n = cross(b - a, c - a);
    const vec2 uv = max(vec2(dot(cross(p - a, c - a), n), dot(cross(b - a, p - a), n)) / dot(n, n), vec2(0));
    return uv / max(1.0, uv.x + uv.y);
}
