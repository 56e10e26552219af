// Who traces a scene's rays, and what in.
#pragma once

#include "khr/structures.h"
#include "render/scene_cubes.h"
#include "settings/choices.h"

namespace peelray {

struct TracerChoice {
    Tracer tracer = Tracer::ldc;  ///< none that is_on_cpu()
    CubeChoice cubes;
    bool rebuild = false;  ///< for measuring: all cubes or structures anew in every frame, as if everything changed
    /// Of `khr`: what becomes of the structure of a body that changes its shape, or, with `rebuild`, of every one.
    /// `keep` leaves all as they were first: for measuring the rays alone.
    StructureUpdate structures = StructureUpdate::rebuild;

    bool operator==(const TracerChoice&) const = default;

    /// How many of the first bodies are built once.
    uint32_t fixed_bodies(const Assembly& assembly) const { return rebuild ? 0 : assembly.fixed; }
};

}  // namespace peelray
