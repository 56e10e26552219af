// Emissive triangles as lamps: which of them light the scene, and how often each is chosen.
#pragma once

#include <cstdint>
#include <vector>

namespace peelray {

/// A triangle that light is looked for on.
struct Emitter {
    uint32_t instance = 0, triangle = 0;  ///< of an Assembly
    uint32_t id = 0;                      ///< in the scene's file order, as of a Geometry
    float probability = 0;                ///< of it being chosen, (0, 1]
    float cumulative = 0;                 ///< of it or one before it; the last one's is 1
};

/// In the order of their instances and triangles; empty: nothing emits.
using Emitters = std::vector<Emitter>;

}  // namespace peelray
