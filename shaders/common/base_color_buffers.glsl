// What gives the base colour of a triangle and its alpha, at bindings BASE_COLOR_FIRST_BINDING ... + 5.
#include "common/material.h"
BUFFER(readonly, BASE_COLOR_FIRST_BINDING + 0, GpuMaterial, materials)
BUFFER(readonly, BASE_COLOR_FIRST_BINDING + 1, GpuTexture, texture_infos)
IMAGE(BASE_COLOR_FIRST_BINDING + 2, utexture2DArray, texels)
BUFFER(readonly, BASE_COLOR_FIRST_BINDING + 3, vec2, uvs)
BUFFER(readonly, BASE_COLOR_FIRST_BINDING + 4, vec4, colors)
BUFFER(readonly, BASE_COLOR_FIRST_BINDING + 5, uint, triangle_materials)
