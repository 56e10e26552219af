// Which hits count, asked in hit shaders. Bindings are those of scene_buffers.glsl from KHR_SCENE_FIRST_BINDING on. Include after
// khr_ray.glsl.
#include "common/material.h"
BUFFER(readonly, KHR_SCENE_FIRST_BINDING + 1, GpuMaterial, materials)
BUFFER(readonly, KHR_SCENE_FIRST_BINDING + 2, GpuTexture, texture_infos)
IMAGE(KHR_SCENE_FIRST_BINDING + 3, utexture2DArray, texels)
BUFFER(readonly, KHR_SCENE_FIRST_BINDING + 5, vec2, uvs)
BUFFER(readonly, KHR_SCENE_FIRST_BINDING + 6, vec4, colors)
BUFFER(readonly, KHR_SCENE_FIRST_BINDING + 7, uint, triangle_materials)
BUFFER(readonly, KHR_SCENE_FIRST_BINDING + 9, vec3, positions)
BUFFER(readonly, KHR_SCENE_FIRST_BINDING + 10, uvec3, triangles)
#include "common/material.glsl"

/// Does the ray meet a side of the triangle that is not there? By the corners in the body's space, as in the cubes: what the device calls
/// a front depends on how an instance is flagged. `to_light`: light comes the other way, and meets the front where the ray meets the back.
bool khrCulled(uint triangle, bool to_light) {
    if (!singleSided(triangle)) return false;
    const uvec3 corners = triangles[triangle];
    const vec3 a = positions[corners.x];
    return dot(cross(positions[corners.y] - a, positions[corners.z] - a), gl_ObjectRayDirectionEXT) >= 0.0 != to_light;
}
