// The SPIR-V that the build embeds (cmake/shaders.cmake).
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace peelray {

struct EmbeddedShader {
    std::string_view name;  ///< the shader's file name without ".comp"; other stages keep their suffix
    std::span<const uint32_t> code;
};

/// The library's own shaders (folder shaders/).
std::span<const EmbeddedShader> peelray_shaders();

}  // namespace peelray
