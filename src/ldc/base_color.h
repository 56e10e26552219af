// What gives the base colour of triangles and its alpha, on the device.
#pragma once

#include <span>
#include <vector>

#include "gpu/commands.h"

namespace peelray {

struct TriangleBuffers;

/// The bindings of shaders/common/base_color_buffers.glsl.
struct BaseColorBuffers {
    Buffer materials;           ///< GpuMaterial each
    Buffer texture_infos;       ///< GpuTexture each
    Buffer texels;              ///< uint32 each: sRGB-encoded colour and alpha
    Buffer uvs;                 ///< vec2 per vertex
    Buffer colors;              ///< vec4 per vertex; read where a material is MATERIAL_COLORED
    Buffer triangle_materials;  ///< uint32 per triangle

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
