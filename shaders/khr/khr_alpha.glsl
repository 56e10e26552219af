// The alpha test in hit shaders. Bindings are those of scene_buffers.glsl from KHR_SCENE_FIRST_BINDING on. Include after khr_ray.glsl.
#include "common/material.h"
BUFFER(readonly, KHR_SCENE_FIRST_BINDING + 1, GpuMaterial, materials)
BUFFER(readonly, KHR_SCENE_FIRST_BINDING + 2, GpuTexture, texture_infos)
BUFFER(readonly, KHR_SCENE_FIRST_BINDING + 3, uint, texels)
BUFFER(readonly, KHR_SCENE_FIRST_BINDING + 5, vec2, uvs)
BUFFER(readonly, KHR_SCENE_FIRST_BINDING + 6, vec4, colors)
BUFFER(readonly, KHR_SCENE_FIRST_BINDING + 7, uint, triangle_materials)
BUFFER(readonly, KHR_SCENE_FIRST_BINDING + 10, uvec3, triangles)
#include "common/alpha_test.glsl"
