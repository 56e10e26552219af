#include "builtin/walker_motion.h"

#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <numbers>

namespace peelray {

using glm::vec3;

namespace {

constexpr float tau = 2 * std::numbers::pi_v<float>;
constexpr vec3 right_to_left{1, 0, 0}, upwards{0, 1, 0}, forwards{0, 0, 1};

float radians(float degrees) {
    return degrees * tau / 360;
}

/// From 0 to 1 without a kink while x goes from `low` to `high`.
float ease(float low, float high, float x) {
    const float t = std::clamp((x - low) / (high - low), 0.f, 1.f);
    return t * t * (3 - 2 * t);
}

// Shares of a foot's cycle, which begins when its heel comes down.
constexpr float flat_from = 0.09f, heel_up_from = 0.33f, toes_off = 0.61f;
constexpr float middle_of_stance = 0.29f;
constexpr float track = 0.066f;  // of a foot, to the side of the path

/// Toes up, radians.
float foot_pitch(float cycle) {
    const float landing = radians(20), leaving = radians(-44);
    if (cycle < heel_up_from) return landing * (1 - ease(0, flat_from, cycle));
    if (cycle < toes_off) return leaving * std::pow((cycle - heel_up_from) / (toes_off - heel_up_from), 1.9f);
    // Goes on a little, then swings to the next landing.
    const float u = (cycle - toes_off) / (1 - toes_off);
    const float speed = leaving * 1.9f / (toes_off - heel_up_from) * (1 - toes_off);
    return leaving + speed * u * (1 - u) * (1 - u) * (1 - u) + (landing - leaving) * ease(0.02f, 0.96f, u);
}

/// Against the foot: on the floor they stay flat.
float toe_pitch(float cycle) {
    if (cycle < heel_up_from) return 0;
    const float flat = -foot_pitch(cycle);
    if (cycle < toes_off) return flat;
    return flat > 0 ? flat * (1 - ease(toes_off, toes_off + 0.12f, cycle)) : 0;
}

/// Goes from one value to another with given speeds at both ends while u goes from 0 to 1.
float hermite(float u, float from, float leaving, float to, float arriving) {
    const float u2 = u * u, u3 = u2 * u;
    return (2 * u3 - 3 * u2 + 1) * from + (u3 - 2 * u2 + u) * leaving + (3 * u2 - 2 * u3) * to + (u3 - u2) * arriving;
}

/// Of a foot: how far its print lies ahead of the root along the path, how far the ankle is ahead of where it is when
/// the foot stands flat on that print, and the ankle's height.
struct Tread {
    float print, ahead, height;
};

Tread tread_on_floor(float cycle, float stride) {
    const FootRoll roll = roll_foot(foot_pitch(cycle), toe_pitch(cycle));
    return {stride * (middle_of_stance - cycle) - 0.020f, roll.ahead, roll.height};
}

Tread tread(float cycle, float stride) {
    if (cycle <= toes_off) return tread_on_floor(cycle, stride);
    // Through the air from the last print to the next, with the speeds of both.
    constexpr float step = 1e-3f;
    const float length = 1 - toes_off, u = (cycle - toes_off) / length, scale = length / step;
    const Tread from = tread_on_floor(toes_off, stride), before = tread_on_floor(toes_off - step, stride),
                to = tread_on_floor(0, stride), after = tread_on_floor(step, stride);
    const float lift = 0.045f * std::pow(std::sin(tau / 2 * u), 2.f);
    return {hermite(u, from.print, scale * (from.print - before.print), to.print, scale * (after.print - to.print)),
            hermite(u, from.ahead, scale * (from.ahead - before.ahead), to.ahead, scale * (after.ahead - to.ahead)),
            roll_foot(foot_pitch(cycle), toe_pitch(cycle)).height + lift};
}

FootPlace walking_foot(const WalkPath& path, Side side, float cycle) {
    const float stride = tau * path.radius / float(path.strides), sign = side == Side::left ? 1.f : -1.f;
    const Tread at = tread(cycle, stride);
    // Along the circle, whose middle lies to the left; the foot rolls straight on.
    const float angle = at.print / path.radius, radius = path.radius - sign * track;
    FootPlace out;
    out.yaw = angle + sign * radians(5);
    out.ankle = {path.radius - radius * std::cos(angle), at.height, radius * std::sin(angle)};
    out.ankle += at.ahead * vec3(std::sin(out.yaw), 0, std::cos(out.yaw));
    out.pitch = foot_pitch(cycle);
    out.toes = toe_pitch(cycle);
    return out;
}

/// Hips, spine and head while walking.
void move_trunk(WalkerPose& pose, float phase) {
    const float wave = tau * phase;
    pose.set_hips({0.016f * std::sin(wave - 0.2f), 0.778f + 0.012f * std::cos(2 * (wave - tau * 0.30f)), -0.010f});
    const float yaw = -radians(7) * std::cos(wave), list = radians(3.5f) * std::sin(wave);
    pose.turn(Joint::hips, right_to_left, radians(2));
    pose.turn(Joint::hips, forwards, list - radians(0.6f));
    pose.turn(Joint::hips, upwards, yaw);
    // The shoulders turn against the hips, and stay more level.
    for (const Joint joint : {Joint::spine, Joint::chest}) {
        pose.turn(joint, right_to_left, radians(1.5f));
        pose.turn(joint, forwards, -0.75f * list - radians(0.8f));
        pose.turn(joint, upwards, radians(8) * std::cos(wave - 0.15f));
    }
    // The head looks where the way bends to, and nods a little after each step.
    pose.turn(Joint::neck, upwards, radians(6) - radians(5) * std::cos(wave - 0.15f));
    pose.turn(Joint::neck, right_to_left, -radians(3));
    pose.turn(Joint::head, upwards, radians(5) - radians(4) * std::cos(wave - 0.15f));
    pose.turn(Joint::head, right_to_left, -radians(2) + radians(1.5f) * std::cos(2 * wave - 1.2f));
    pose.turn(Joint::head, forwards, radians(1.5f) + radians(1.5f) * std::sin(wave - 0.5f));
}

/// Weight on the right leg; the right arm is left as it is bound.
WalkerPose at_ease() {
    WalkerPose pose;
    pose.set_hips({-0.028f, 0.781f, -0.008f});
    pose.turn(Joint::hips, forwards, -radians(4));
    pose.turn(Joint::hips, upwards, radians(4));
    pose.turn(Joint::spine, forwards, radians(4.5f));
    pose.turn(Joint::chest, forwards, radians(3));
    pose.turn(Joint::chest, upwards, -radians(5));
    pose.turn(Joint::neck, forwards, -radians(2));
    pose.turn(Joint::neck, upwards, -radians(9));
    pose.turn(Joint::head, upwards, -radians(13));
    pose.turn(Joint::head, forwards, -radians(4));
    pose.set_arm(Side::left, {.ahead = radians(6),
                              .aside = radians(13),
                              .roll = radians(-22),
                              .elbow = radians(24),
                              .wrist = radians(8),
                              .twist = radians(14)});
    const float flat = roll_foot(0, 0).height;
    pose.set_foot(Side::left, {{0.115f, flat, 0.055f}, radians(20), 0, 0});
    pose.set_foot(Side::right, {{-0.085f, flat, -0.03f}, -radians(8), 0, 0});
    return pose;
}

}  // namespace

Placement place_on_path(const WalkPath& path, float share) {
    Placement out;
    // Facing +z the middle of the circle lies to the left, at +x.
    const float angle = tau * share;
    const glm::quat rotation = glm::angleAxis(angle, upwards);
    out.rotation = glm::dquat(rotation);
    // A millimetre above the floor: as much as the soles may dip where they bend.
    out.translation = rotation * vec3(-path.radius, 0.001f, 0);
    return out;
}

WalkerPose walking_pose(const WalkPath& path, float phase) {
    WalkerPose pose;
    move_trunk(pose, phase);
    for (const Side side : {Side::left, Side::right}) {
        const float cycle = side == Side::left ? phase : phase + 0.5f;
        // An arm swings with the other side's leg.
        const float swing = -std::cos(tau * cycle - 0.1f), bend = -std::cos(tau * cycle - 0.55f);
        pose.turn(side == Side::left ? Joint::left_collar : Joint::right_collar, upwards,
                  (side == Side::left ? -1.f : 1.f) * radians(5) * swing);
        pose.set_arm(side, {.ahead = radians(2) + radians(29) * swing,
                            .aside = radians(16),
                            .roll = radians(-14),
                            .elbow = radians(20) + radians(13) * bend,
                            .wrist = radians(6) + radians(7) * bend,
                            .twist = radians(12)});
        pose.set_foot(side, walking_foot(path, side, cycle - std::floor(cycle)));
    }
    return pose;
}

WalkerPose standing_pose() {
    WalkerPose pose = at_ease();
    pose.set_arm(Side::right, {.ahead = radians(-3),
                               .aside = radians(17),
                               .roll = radians(-20),
                               .elbow = radians(18),
                               .wrist = radians(6),
                               .twist = radians(10)});
    return pose;
}

WalkerPose waving_pose(float phase) {
    WalkerPose pose = at_ease();
    const float wave = tau * phase;
    pose.turn(Joint::spine, forwards, radians(1.5f) + radians(1) * std::sin(wave));
    pose.turn(Joint::chest, forwards, radians(2) + radians(1) * std::sin(wave - 0.3f));
    pose.turn(Joint::head, forwards, -radians(5) - radians(2.5f) * std::sin(wave - 0.5f));
    pose.turn(Joint::right_collar, forwards, -radians(8));
    pose.set_arm(Side::right, {.ahead = radians(14),
                               .aside = radians(80),
                               .roll = radians(72),
                               .elbow = radians(72) + radians(19) * std::sin(wave),
                               .wrist = radians(14) * std::sin(wave - 0.7f),
                               .twist = radians(-10)});
    return pose;
}

}  // namespace peelray
