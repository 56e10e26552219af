// Materials of triangles and their textures, on the device.
#pragma once

#include <span>
#include <vector>

#include "gpu/commands.h"

namespace peelray {

struct TriangleBuffers;

/// The bindings of shaders/common/base_color_buffers.glsl.
struct BaseColorBuffers {
    Buffer materials;            ///< GpuMaterial each
    Buffer texture_infos;        ///< GpuTexture each
    Image2D texels;              ///< words of all textures (common/material.h, TEXEL_ROW_BITS)
    Buffer uvs;                  ///< vec2 per vertex, set after set; then, if there are any, tangents, vec4 per vertex
    Buffer colors;               ///< vec4 per vertex; read where a material is MATERIAL_COLORED
    Buffer triangle_materials;   ///< uint32 per triangle
    uint32_t first_tangent = 0;  ///< in `uvs`, counted in vec2
    uint32_t kinds = 0;          ///< MATERIALS_* (common/material.h), of the materials that triangles have

    /// Of the shaders that evaluate materials.
    Constant constant() const { return {"material_kinds", kinds}; }

    uint64_t bytes() const {
        return materials.bytes() + texture_infos.bytes() + texels.bytes() + uvs.bytes() + colors.bytes() +
               triangle_materials.bytes();
    }
};

std::vector<Binding> base_color_bindings(const BaseColorBuffers& buffers);

/// `bindings`, and the same for a pass that asks which hits count: tests the alpha of masked triangles, culls the backs
/// of single-sided ones. Where there are neither, it uses none of them.
std::vector<Binding> with_hit_materials(std::span<const Binding> bindings, const TriangleBuffers& triangles);

}  // namespace peelray
