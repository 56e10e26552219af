// The alpha test of masked materials: where a triangle has a surface. Include after the buffers it reads: triangles and
// those of base_color_buffers.glsl.
#ifndef PEELRAY_ALPHA_TEST_GLSL
#define PEELRAY_ALPHA_TEST_GLSL

#include "common/material.h"

#include "common/textures.glsl"
#include "path/shading_numbers.h"

/// May the triangle have holes?
bool alphaMasked(uint triangle) { return materials[triangle_materials[triangle]].alpha_cutoff > 0.0; }

/// Is there a surface at the point with these weights of the triangle's second and third corner?
bool alphaPresent(uint triangle, vec2 weights) {
    const GpuMaterial m = materials[triangle_materials[triangle]];
    if (m.alpha_cutoff <= 0.0) return true;
    const uvec3 corners = triangles[triangle];
    float alpha = m.alpha;
    if ((m.flags & MATERIAL_COLORED) != 0u) {
        const float a = colors[corners.x].a;
        alpha *= a + (colors[corners.y].a - a) * weights.x + (colors[corners.z].a - a) * weights.y;
    }
    if (m.texture >= 0) {
        const vec2 a = uvs[corners.x];
        alpha *= sampleTexture(m.texture, a + (uvs[corners.y] - a) * weights.x + (uvs[corners.z] - a) * weights.y).a;
    }
    return alpha >= m.alpha_cutoff - ALPHA_ROUNDING;
}

#endif
