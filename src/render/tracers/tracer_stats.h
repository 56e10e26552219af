// What a tracer traced rays in.
#pragma once

#include <vector>

#include "khr/structures.h"
#include "render/scene_cubes.h"

namespace peelray {

/// Of the tracers that have none, cubes and structures are empty.
struct TracerStats {
    SceneCubes::Stats cubes;
    std::vector<LdcBody> bodies;                        ///< with the grids of their cubes
    std::vector<uint32_t> shown;                        ///< how many instances show each of them
    uint32_t rebuilt = 0;                               ///< cubes that were built for this frame
    Structures::Stats structures;                       ///< of `khr`
    StructureUpdate update = StructureUpdate::rebuild;  ///< of those of them that are not kept
};

}  // namespace peelray
