// Points and lines as surfaces that rays can hit.
#pragma once

#include <cstdint>
#include <span>

#include "scene/scene.h"

namespace peelray {

enum class LineMode : uint8_t { points, lines, loop, strip };

/// Puts a ball around each point, or a tube around each line with balls at its ends, in place of the primitive's
/// vertices: `corners` name those that are meant, in the order of the mode. Everything that belongs to a vertex goes
/// with what stands around it; normals point outwards. Lines without length are balls. Beforehand the primitive has no
/// triangles.
void thicken(Primitive& primitive, std::span<const uint32_t> corners, LineMode mode, float radius);

/// How many triangles that makes.
uint64_t thickened_triangles(size_t corners, LineMode mode);

}  // namespace peelray
