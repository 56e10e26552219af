// A scene's triangles on the device.
#pragma once

#include <glm/glm.hpp>
#include <span>

#include "gpu/buffer.h"
#include "ldc/base_color.h"

namespace peelray {

/// Triangles on the device, in the spaces of their bodies.
struct TriangleBuffers {
    Buffer positions;       ///< vec3 each, tightly packed
    Buffer triangles;       ///< three uint32 indices each
    uint32_t count = 0;     ///< triangles, < 2^30
    uint32_t vertices = 0;  ///< behind them and behind the triangles there may be copies (MergedInstances)
    /// Where they have holes; must outlive this. Null: no material is masked.
    const BaseColorBuffers* masks = nullptr;
    /// Which of them show their front only; the same buffers, which must outlive this. Null: all show both sides.
    const BaseColorBuffers* sides = nullptr;

    TriangleBuffers() = default;
    /// Uploads. Throws Error beyond 2^30 triangles or the device's memory.
    TriangleBuffers(Device& device, std::span<const glm::vec3> points, std::span<const glm::uvec3> indices);
};

}  // namespace peelray
