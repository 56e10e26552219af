// Key frames: moments of a scene's animations.
#pragma once

#include <string>
#include <vector>

#include "scene/moment.h"

namespace peelray {

/// The animations that `which` stands for: a name, an index or "all". Throws Error for an unknown animation, listing
/// those there are, and for a scene without any.
std::vector<const Animation*> find_animations(const Scene& scene, const std::string& which);

/// Makes the morph targets that were left for later; part of opening a scene that is to be animated.
void complete_targets(Scene& scene);

/// The moment one frame earlier, where `fps` frames are shown in a second: of frame k that of frame k - 1, to the last
/// bit. Before its beginning all stands as at its beginning: 0.
double moment_before(double time, double fps);

/// The moment `time` (seconds, from 0) of animations: nodes, morph weights, and the cameras and lights that hang on
/// nodes. Beyond its duration an animation starts again; what none of them moves stands as at rest. Of what is
/// generated only the time: a Simulation places it. `which`: see find_animations(), empty: the scene at rest; of two
/// animations that move the same, the later one wins. The scene's targets must be complete. Throws Error like
/// find_animations().
Moment moment_of(const Scene& scene, const std::string& which, double time);

}  // namespace peelray
