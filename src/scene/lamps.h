// The lights of a moment in the order in which all tracers count them.
#pragma once

#include <cstdint>
#include <vector>

#include "scene/scene.h"

namespace peelray {

/// Directional lights, then lamps with a place in the scene, then the environment's lights. Of more than LAMPS_EACH
/// lamps with a place, hits with sampled lobes draw one (docs/frame.md section 5).
struct Lamps {
    std::vector<Light> lights;
    uint32_t first = 0, count = 0;  ///< those with a place
    /// Of these: the probability of each or one before it being tried, by its intensity; the last one's is 1.
    std::vector<float> cumulative;
};

Lamps lamps_of(const std::vector<Light>& own, const std::vector<Light>& of_environment);

}  // namespace peelray
