#include "builtin/walker_pose.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>

namespace peelray {

using glm::quat;
using glm::vec3;

namespace {

Joint parent_of(Joint joint) {
    return walker_joints()[size_t(joint)].parent;
}

Joint on(Side side, Joint left, Joint right) {
    return side == Side::left ? left : right;
}

/// The rotation that takes one pair of directions to another: the first exactly, the second as far as it goes.
quat between(const vec3& from, const vec3& from_second, const vec3& to, const vec3& to_second) {
    const auto frame = [](const vec3& first, const vec3& second) {
        const vec3 x = glm::normalize(first), z = glm::normalize(glm::cross(x, second));
        return glm::mat3(x, glm::cross(z, x), z);
    };
    return glm::normalize(glm::quat_cast(frame(to, to_second) * glm::transpose(frame(from, from_second))));
}

}  // namespace

WalkerPose::WalkerPose() : hips_(joint_position(Joint::hips)) {
    rotations_.fill(quat(1, 0, 0, 0));
}

void WalkerPose::turn(Joint joint, const vec3& axis, float angle) {
    turn(joint, glm::angleAxis(angle, axis));
}

void WalkerPose::turn(Joint joint, const quat& rotation) {
    quat& current = rotations_[size_t(joint)];
    current = glm::normalize(rotation * current);
}

vec3 WalkerPose::translation(Joint joint) const {
    return joint == Joint::hips ? hips_ : joint_position(joint) - joint_position(parent_of(joint));
}

quat WalkerPose::orientation(Joint joint) const {
    return joint == Joint::root ? rotation(joint) : orientation(parent_of(joint)) * rotation(joint);
}

vec3 WalkerPose::position(Joint joint) const {
    if (joint == Joint::root) return vec3(0);
    const Joint parent = parent_of(joint);
    return position(parent) + orientation(parent) * translation(joint);
}

void WalkerPose::set_arm(Side side, const ArmBend& bend) {
    const float sign = side == Side::left ? 1.f : -1.f;
    const Joint arm = on(side, Joint::left_arm, Joint::right_arm),
                forearm = on(side, Joint::left_forearm, Joint::right_forearm),
                hand = on(side, Joint::left_hand, Joint::right_hand);
    const vec3 bound = glm::normalize(joint_position(forearm) - joint_position(arm));
    const vec3 hinge = glm::normalize(vec3(-bound.y, sign * std::abs(bound.x), 0));  // to the left, across the arm
    const float raised = std::atan2(std::abs(bound.x), -bound.y);
    turn(arm, bound, -sign * bend.roll);
    turn(arm, vec3(0, 0, 1), sign * (bend.aside - raised));
    turn(arm, vec3(1, 0, 0), -bend.ahead);
    turn(forearm, hinge, -bend.elbow);
    turn(forearm, bound, -sign * bend.twist);
    turn(hand, hinge, -bend.wrist);
}

void WalkerPose::set_foot(Side side, const FootPlace& foot) {
    const Joint thigh = on(side, Joint::left_thigh, Joint::right_thigh),
                shin = on(side, Joint::left_shin, Joint::right_shin),
                ankle = on(side, Joint::left_foot, Joint::right_foot),
                toes = on(side, Joint::left_toes, Joint::right_toes);
    const vec3 upper = joint_position(shin) - joint_position(thigh),
               lower = joint_position(ankle) - joint_position(shin);
    const float a = glm::length(upper), b = glm::length(lower);
    const vec3 hip = position(thigh), way = foot.ankle - hip;
    const float distance = std::min(glm::length(way), 0.9995f * (a + b));
    const vec3 direction = glm::normalize(way);
    const quat heading = glm::angleAxis(foot.yaw, vec3(0, 1, 0));
    // The knee points where the foot does, half way back to where the hips point.
    const vec3 ahead = glm::normalize(heading * vec3(0, 0, 1) + orientation(Joint::hips) * vec3(0, 0, 1));
    const vec3 knee_side = glm::normalize(ahead - glm::dot(ahead, direction) * direction);
    const float cosine = std::clamp((a * a + distance * distance - b * b) / (2 * a * distance), -1.f, 1.f);
    const vec3 to_knee = cosine * direction + std::sqrt(1 - cosine * cosine) * knee_side;
    const vec3 to_ankle = distance * direction - a * to_knee;
    const vec3 forwards(0, 0, 1);
    const quat thigh_turn = between(upper, forwards, to_knee, knee_side),
               shin_turn = between(lower, forwards, to_ankle, knee_side);
    const quat foot_turn = heading * glm::angleAxis(-foot.pitch, vec3(1, 0, 0));
    rotations_[size_t(thigh)] = glm::inverse(orientation(Joint::hips)) * thigh_turn;
    rotations_[size_t(shin)] = glm::inverse(thigh_turn) * shin_turn;
    rotations_[size_t(ankle)] = glm::inverse(shin_turn) * foot_turn;
    rotations_[size_t(toes)] = glm::angleAxis(-foot.toes, vec3(1, 0, 0));
}

FootRoll roll_foot(float pitch, float toes) {
    // Seen from the side, heel and tip of the sole are round: circles of this radius.
    constexpr float round = 0.003f;
    const vec3 ankle = joint_position(Joint::left_foot), joint = joint_position(Joint::left_toes);
    const auto turned = [](const vec3& v, float angle) {
        return glm::vec2(v.z * std::cos(angle) - v.y * std::sin(angle), v.y * std::cos(angle) + v.z * std::sin(angle));
    };
    const vec3 heel(0, round, -0.0685f), tip(0, round, 0.168f);
    // Of each: from the ankle, as (ahead, up).
    const glm::vec2 at_heel = turned(heel - ankle, pitch), at_joint = turned(joint - ankle, pitch),
                    at_tip = at_joint + turned(tip - joint, pitch + toes);
    const float lowest = std::min({at_heel.y, at_joint.y - joint.y + round, at_tip.y});
    FootRoll out{round - lowest, 0};
    // What touches stays: the heel rolls on its circle, the toes' joint stands.
    if (pitch > 0)
        out.ahead = (heel - ankle).z - at_heel.x - round * pitch;
    else
        out.ahead = (joint - ankle).z - at_joint.x;
    return out;
}

}  // namespace peelray
