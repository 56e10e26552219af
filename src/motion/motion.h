// What can move in a scene: what its animations reach.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"

namespace peelray {

/// Which nodes an animation changes; one entry per node of the scene.
struct Motion {
    std::vector<bool> moves;   ///< its own translation, rotation or scale
    std::vector<bool> scales;  ///< its own scale
    std::vector<bool> morphs;  ///< its weights
    bool generates = false;    ///< what is generated moves (Scene::generated)
};

/// Of the animation `which` (as moment_of() takes it; empty: none). Throws Error for an unknown one.
Motion motion_of(const Scene& scene, const std::string& which);

}  // namespace peelray
