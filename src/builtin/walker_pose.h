// Poses of the figure: turns of its joints, and legs that reach for the floor. Private to src/builtin.
#pragma once

#include "builtin/walker.h"

namespace peelray {

enum class Side : uint8_t { left, right };

/// A foot relative to the figure's root.
struct FootPlace {
    glm::vec3 ankle;
    float yaw;    ///< to the figure's left, radians
    float pitch;  ///< toes up
    float toes;   ///< pitch of the toes against the foot
};

/// Radians. All 0: straight down.
struct ArmBend {
    float ahead = 0, aside = 0;  ///< the upper arm, away from the body
    float roll = 0;              ///< about its own axis: 90° let the elbow bend upwards when the arm points aside
    float elbow = 0, wrist = 0;
    float twist = 0;  ///< of the forearm: the palm turns to the body
};

/// Turns of the joints against the bound pose; every joint's axes are the world's there.
class WalkerPose {
  public:
    WalkerPose();

    /// Turns a joint after what it was turned before.
    void turn(Joint joint, const glm::vec3& axis, float angle);
    void turn(Joint joint, const glm::quat& rotation);
    /// Where the hips are, from the root.
    void set_hips(const glm::vec3& at) { hips_ = at; }
    void set_arm(Side side, const ArmBend& bend);
    /// Bends hip, knee, ankle and toes so that the foot stands there; hips and everything above must be set. Where it
    /// is out of reach the leg is straight and points to it.
    void set_foot(Side side, const FootPlace& foot);

    const glm::quat& rotation(Joint joint) const { return rotations_[size_t(joint)]; }
    /// From the parent.
    glm::vec3 translation(Joint joint) const;
    /// In the root's space.
    glm::vec3 position(Joint joint) const;
    glm::quat orientation(Joint joint) const;

  private:
    std::array<glm::quat, joint_count> rotations_;
    glm::vec3 hips_;
};

/// How high the ankle must be for the foot to touch the floor, and how far it is ahead of where it is when the foot
/// stands flat and what touches the floor (heel, sole or toes) has not moved.
struct FootRoll {
    float height, ahead;
};
FootRoll roll_foot(float pitch, float toes);

}  // namespace peelray
