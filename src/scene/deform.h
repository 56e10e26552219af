// Morph targets and skins: where a primitive's vertices are at a moment.
#pragma once

#include <span>

#include "scene/moment.h"

namespace peelray {

/// A primitive's vertices in world space.
struct Deformed {
    std::vector<glm::vec3> positions, normals;
    std::vector<glm::vec4> tangents;  ///< empty where the primitive has none
    bool mirrors = false;             ///< the transform turns the triangles inside out
};

/// Does the primitive have only its shape at rest?
inline bool is_rigid(const Primitive& primitive, const Node& node) {
    return primitive.targets.empty() && (primitive.joints.empty() || node.skin < 0);
}

/// A primitive with other vertices.
Primitive with_surface(const Primitive& primitive, const Moment::Surface& surface);

/// Of each joint of a node's skin: from the mesh as it was bound to where the joint is now. An instance's are moved
/// from its parent to itself. `worlds`: of all nodes; `world`: the node's own.
std::vector<glm::mat4> joint_matrices(const Scene& scene, const Node& node, std::span<const glm::mat4> worlds,
                                      const glm::mat4& world);

/// Morphs (glTF 2.0, section 3.7.2.2), then moves: by the skin's joints (section 3.7.3.3), or by the node where a
/// vertex has none. `worlds`: of all nodes. Normals come out unit; those of flat primitives are the moved triangles'
/// own.
Deformed deform(const Scene& scene, const Node& node, const Primitive& primitive, std::span<const float> weights,
                std::span<const glm::mat4> worlds, const glm::mat4& world);

/// The same for a primitive that has only its shape at rest.
Deformed transformed(const Primitive& primitive, const glm::mat4& matrix);

/// Where the vertices of a node's primitive are at a moment.
Deformed placed(const Scene& scene, const Moment& moment, size_t node, const Primitive& primitive);

/// Throws Error, naming the node, for a vertex that a transform moved out of the range of floats.
void check_finite(const glm::vec3& position, const Node& node, size_t vertex);

/// Throws Error for more vertices and triangles, with all instances, than are supported, or none.
void check_size(const Scene& scene, uint64_t vertices, uint64_t triangles);

}  // namespace peelray
