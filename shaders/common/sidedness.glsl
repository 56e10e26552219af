// Which sides of a triangle are shown. Include after the buffers that it reads: materials and triangle_materials.
#ifndef PEELRAY_SIDEDNESS_GLSL
#define PEELRAY_SIDEDNESS_GLSL

#include "common/material.h"

/// Do rays from behind, whence its corners go clockwise, pass the triangle?
bool singleSided(uint triangle) { return (materials[triangle_materials[triangle]].flags & MATERIAL_SINGLE_SIDED) != 0u; }

#endif
