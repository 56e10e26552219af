// The emissive triangles of a scene.
#pragma once

#include "assembly/assembly.h"
#include "scene/emitters.h"

namespace peelray {

/// Emissive triangles, each chosen in proportion to its power at rest: its area there times what its texels emit on the
/// mean. Every triangle of an emissive material has a share, since what its texels hold between is not looked at.
Emitters emitters_of(const Scene& scene, const Assembly& assembly);

}  // namespace peelray
