// Which joints pull at the vertices of a skin. Private to src/builtin.
#pragma once

#include <span>

#include "builtin/closed_mesh.h"
#include "scene/scene.h"

namespace peelray {

/// What a joint holds: all around the line from `a` to `b`.
struct Bone {
    uint16_t joint;
    glm::vec3 a, b;
    float radius;
};

/// Every vertex follows the bone that is nearest to it in terms of the bone's thickness, and the borders between bones
/// are softened by letting the weights flow over the surface (never through the air to a neighbouring limb) some
/// `reach(p)` far. At most four joints per vertex; the weights sum to one.
std::vector<JointWeights> soft_weights(const ClosedMesh& mesh, std::span<const Bone> bones, size_t joints,
                                       const std::function<float(const glm::vec3&)>& reach);

}  // namespace peelray
