// A box around a scene, of a moment or of all: what frames the picture and where the floor lies.
#pragma once

#include <string>

#include "scene/box.h"
#include "scene/scene.h"

namespace peelray {

/// The box of all triangles as the scene stands.
Box bounds(const Scene& scene);

/// The box of a scene at rest and at moments of animations (`which`: see animate()); of what is generated, of all that
/// it may reach. The moments are spread evenly and over the keys, at most 66; of large meshes a share of the vertices
/// is looked at, so that the cost does not grow with them. So at moments in between something may reach a little
/// farther. Leaves the scene at some moment. Throws Error like animate().
Box bounds_over(Scene& scene, const std::string& which);

}  // namespace peelray
