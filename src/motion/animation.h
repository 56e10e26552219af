// Key frames: a scene at a moment of its animations.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"

namespace peelray {

/// The animations that `which` stands for: a name, an index or "all". Throws Error for an unknown animation, listing
/// those there are, and for a scene without any.
std::vector<const Animation*> find_animations(const Scene& scene, const std::string& which);

/// Makes the morph targets that were left for later. animate() begins with it; call it before looking at
/// Primitive::targets of a scene that was not animated yet.
void complete_targets(Scene& scene);

/// Puts the scene into the moment `time` (seconds, from 0) of animations: nodes, morph weights, and the cameras and
/// lights that hang on nodes. Beyond its duration an animation starts again; what none of them moves stands as at rest.
/// `which`: see find_animations(); of two that move the same, the later one wins. The result depends on nothing that
/// was done to the scene before. Throws Error like find_animations().
void animate(Scene& scene, const std::string& which, double time);

/// Undoes animate().
void stand_at_rest(Scene& scene);

}  // namespace peelray
