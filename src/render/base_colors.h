// Materials, textures and what of vertices they read, uploaded.
#pragma once

#include "assembly/assembly.h"
#include "ldc/base_color.h"

namespace peelray {

/// A buffer that holds `data`; never empty, so that it can be bound.
template <typename T>
Buffer upload(Device& device, Commands& commands, const char* name, const std::vector<T>& data) {
    Buffer buffer(device, name, std::max<size_t>(data.size(), 1) * sizeof(T));
    if (!data.empty()) commands.upload(buffer, std::span<const T>(data));
    return buffer;
}

/// Of each of the scene's materials: does a triangle have it?
std::vector<bool> used_materials(const Scene& scene, const Assembly& assembly);

enum class MaterialsFor {
    shading,
    hits,  ///< which of them count: sides and alpha tests, which read the largest level of few textures
};

/// `used`: see used_materials().
BaseColorBuffers upload_base_colors(Device& device, Commands& commands, const Scene& scene, const Assembly& assembly,
                                    const std::vector<bool>& used, MaterialsFor purpose);

}  // namespace peelray
