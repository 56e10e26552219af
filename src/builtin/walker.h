// The figure of builtin:walker: its skeleton, its skin and its gait. Private to src/builtin.
#pragma once

#include <array>

#include "scene/scene.h"

namespace peelray {

/// Joints of the figure, parents first. It faces +z, +x is its left. `left` joints are followed by the same ones of the
/// right side.
enum class Joint : uint8_t {
    root,  // on the floor below the figure
    hips,
    spine,
    chest,
    neck,
    head,
    left_collar,
    left_arm,
    left_forearm,
    left_hand,
    right_collar,
    right_arm,
    right_forearm,
    right_hand,
    left_thigh,
    left_shin,
    left_foot,
    left_toes,
    right_thigh,
    right_shin,
    right_foot,
    right_toes,
    count
};
constexpr size_t joint_count = size_t(Joint::count);

struct JointPlace {
    const char* name;
    Joint parent;  ///< of the root: the root itself
    glm::vec3 at;  ///< where the joint is when the figure is bound: arms half lowered, every joint's axes the world's
};
const std::array<JointPlace, joint_count>& walker_joints();
/// JointPlace::at.
inline glm::vec3 joint_position(Joint joint) {
    return walker_joints()[size_t(joint)].at;
}

/// The figure as it is bound: one closed surface, cut into a primitive for each colour (their borders have the same
/// vertices), eyes, brows and mouth being closed bodies of their own. `materials`: see walker_materials().
std::vector<Primitive> walker_skin(uint32_t first_material);
std::vector<Material> walker_materials();

}  // namespace peelray
