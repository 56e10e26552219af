// The pocket watch of builtin:desk. Private to src/builtin.
#pragma once

#include "builtin/shapes.h"

namespace peelray {

/// Adds a pocket watch with an open lid, its movement to be seen, and its chain. `place`: from millimetres, the dial's
/// middle above the origin, y upwards, 3 o'clock along +x, to the world.
void add_watch(SceneBuilder& build, const glm::mat4& place);

/// A wheel of a movement around y, from y = bottom: involute-like teeth up to `radius`, spokes, a bore. Without
/// normals.
struct GearShape {
    uint32_t teeth = 60;
    float radius = 6, tooth = 0.35f;  ///< of the tips; height of a tooth
    float rim = 0.7f, hub = 1.1f, bore = 0.3f;
    uint32_t spokes = 5;  ///< 0: a full disc
    float spoke = 0.5f;   ///< width
    float bottom = 0, thickness = 0.4f, bevel = 0.03f;
};
Primitive gear(const GearShape& shape);

}  // namespace peelray
