// For headers of structures that C++ and GLSL share (scalar block layout): parameters of passes and records in buffers.
#ifndef PEELRAY_SHARED_H
#define PEELRAY_SHARED_H

#include "peelray/cube.h"

#ifdef __cplusplus
namespace peelray {
using glm::ivec3;
using glm::mat2x4;
using glm::mat4;
using glm::uvec2;
using glm::uvec4;
using glm::vec2;
using glm::vec4;
}  // namespace peelray
#define SHARED_SIZE(type, size) static_assert(sizeof(type) == size, #type)
#else
#define SHARED_SIZE(type, size)
#endif

#endif
