// A scene's bodies as the device's own ray tracing takes them.
#pragma once

#include "assembly/assembly.h"
#include "khr/structures.h"

namespace peelray {

/// Each body in parts that are all opaque or not at all, in the order of its triangles; all are to be kept.
std::vector<StructureBody> structure_bodies(const Scene& scene, const Assembly& assembly);

}  // namespace peelray
