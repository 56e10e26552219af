// A box around a scene, of a moment or of all: what frames the picture and where the floor lies.
#pragma once

#include <string>

#include "scene/box.h"
#include "scene/moment.h"

namespace peelray {

/// The box of all triangles at a moment.
Box bounds(const Scene& scene, const Moment& moment);

/// The box of a scene at rest and at moments of animations (`which`: see moment_of()); of what is generated, of all
/// that it may reach. The moments are spread evenly and over the keys, at most 66; of large meshes a share of the
/// vertices is looked at, so that the cost does not grow with them. So at moments in between something may reach a
/// little farther. Throws Error like moment_of().
Box bounds_over(const Scene& scene, const std::string& which);

}  // namespace peelray
