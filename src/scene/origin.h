// Scenes that stand far from the world's origin (docs/conventions.md, "Far from the origin").
#pragma once

#include <vector>

#include "scene/scene.h"

namespace peelray {

/// Is something at `reach` from the origin too far for the precision of floats, where all there is measures `extent`?
/// At sixteen times that floats are a millionth of it apart.
inline bool is_far(double reach, double extent) {
    return reach > 16 * extent;
}

/// The greatest distance from 0 along an axis.
inline double reach_of(const glm::dvec3& p) {
    return glm::max(glm::abs(p.x), glm::max(glm::abs(p.y), glm::abs(p.z)));
}

/// A node's transform as a file gives it, before it is rounded to floats.
struct ExactNode {
    glm::dmat4 local{1};
    Placement rest;
};

/// The last step of loading: finds out whether the scene is far from the origin; if so, makes it `precise`, chooses its
/// origin and brings meshes whose own positions are far away to the middle of theirs. Then puts cameras and lights
/// where their nodes are; a camera looks at the point of its axis that is nearest to the middle of the scene. `exact`:
/// of all nodes; empty: their matrices are exact.
void settle_origin(Scene& scene, const std::vector<ExactNode>& exact = {});

}  // namespace peelray
