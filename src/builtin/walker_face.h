// The figure's eyes, brows and mouth. Private to src/builtin.
#pragma once

#include "builtin/polygonise.h"
#include "scene/scene.h"

namespace peelray {

/// Closed bodies that lie on the head's surface, without joint weights: both eyes; brows and mouth.
struct WalkerFace {
    Primitive eyes, lines;
};
WalkerFace walker_face(const Field& head);

}  // namespace peelray
