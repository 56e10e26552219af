// The scene's buffers at bindings SCENE_FIRST_BINDING ...; positions, triangles and instances come with
// cube_fetch.glsl or here.
#define MATERIAL_EVALUATION
#include "common/instance.h"
#include "common/material.h"
#include "path/frame.h"
BUFFER(readonly, SCENE_FIRST_BINDING + 0, Frame, frame)
BUFFER(readonly, SCENE_FIRST_BINDING + 1, GpuMaterial, materials)
BUFFER(readonly, SCENE_FIRST_BINDING + 2, GpuTexture, texture_infos)
IMAGE(SCENE_FIRST_BINDING + 3, utexture2DArray, texels)
BUFFER(readonly, SCENE_FIRST_BINDING + 4, vec3, normals)
BUFFER(readonly, SCENE_FIRST_BINDING + 5, vec2, uvs)
BUFFER(readonly, SCENE_FIRST_BINDING + 6, vec4, colors)
BUFFER(readonly, SCENE_FIRST_BINDING + 7, uint, triangle_materials)
BUFFER(readonly, SCENE_FIRST_BINDING + 8, vec4, lookups)  // tables.h, then the environment map
#ifdef SCENE_WITH_TRIANGLES
BUFFER(readonly, SCENE_FIRST_BINDING + 9, vec3, positions)
BUFFER(readonly, SCENE_FIRST_BINDING + 10, uvec3, triangles)
BUFFER(readonly, SCENE_FIRST_BINDING + 11, GpuInstance, instances)
#endif
