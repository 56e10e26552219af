// What is generated (Scene::generated) on the CPU: the twin of the passes of src/render/generators.
#pragma once

#include "motion/cloth.h"
#include "scene/moment.h"

namespace peelray {

/// Simulates one scene from moment to moment. Water and cloth go on from the moment before, or start again where that
/// was later: what comes out depends on nothing but the moment.
class Simulation {
  public:
    /// Puts what is generated where it is at Moment::generated_time: vertices of water and
    /// cloth, places of nodes. `scene`: the
    /// same in every call.
    void place(const Scene& scene, Moment& moment);

    /// Heights and velocities of a Water over its grid.
    struct Heights {
        uint64_t step = 0;
        std::vector<double> heights, velocities;  ///< empty: nothing has been simulated yet
    };
    const std::vector<Heights>& waters() const { return waters_; }

  private:
    std::vector<Heights> waters_;
    std::vector<ClothSimulation> cloths_;
};

/// Makes the beginning of what is generated the scene's state at rest.
void settle(Scene& scene);

}  // namespace peelray
