// The figure's shape: a soft body of round pieces, one group for each garment.
#include "builtin/walker_body.h"

namespace peelray {

namespace {

using glm::vec3;

/// The same on the right side.
vec3 mirrored(const vec3& v) {
    return {-v.x, v.y, v.z};
}

SoftGroup mirrored(SoftGroup group) {
    for (Piece& piece : group.pieces) {
        piece.a = mirrored(piece.a);
        piece.b = mirrored(piece.b);
    }
    for (SoftGroup::Cut& cut : group.cuts) cut.outwards = mirrored(cut.outwards);
    return group;
}

Piece blended(Piece piece, float blend) {
    piece.blend = blend;
    return piece;
}

void add_both(SoftGroup& group, const Piece& left) {
    Piece right = left;
    right.a = mirrored(left.a);
    right.b = mirrored(left.b);
    group.pieces.push_back(left);
    group.pieces.push_back(right);
}

SoftGroup seat() {
    SoftGroup out{.part = uint32_t(Garment::trousers)};
    out.pieces.push_back(cone({-0.045f, 0.81f, -0.012f}, 0.108f, {0.045f, 0.81f, -0.012f}, 0.108f, {1, 1, 1.1f}));
    add_both(out, blended(ball({0.056f, 0.755f, -0.034f}, 0.082f), 0.04f));
    return out;
}

SoftGroup left_leg() {
    SoftGroup out{.part = uint32_t(Garment::trousers), .seam = 0.04f};
    const vec3 hip = joint_position(Joint::left_thigh), knee = joint_position(Joint::left_shin);
    out.pieces.push_back(cone(hip + vec3(-0.001f, -0.03f, 0), 0.082f, knee, 0.066f));
    // The lower leg begins with the very ball that the upper one ends with: no more than a hint of a blend.
    out.pieces.push_back(blended(cone(knee, 0.066f, {0.092f, 0.13f, -0.012f}, 0.068f), 0.006f));
    out.cuts.push_back({{0, -1, 0}, -0.13f, 0.014f});
    return out;
}

SoftGroup left_boot() {
    SoftGroup out{.part = uint32_t(Garment::boots)};
    out.pieces.push_back(cone({0.092f, 0.20f, -0.012f}, 0.052f, {0.092f, 0.08f, -0.014f}, 0.054f));
    out.pieces.push_back(cone({0.092f, 0.050f, -0.022f}, 0.054f, {0.098f, 0.040f, 0.095f}, 0.052f));
    out.pieces.push_back(cone({0.098f, 0.042f, 0.10f}, 0.055f, {0.099f, 0.042f, 0.125f}, 0.054f, {1, 1.05f, 1}));
    out.cuts.push_back({{0, -1, 0}, -0.012f, 0.01f});
    return out;
}

SoftGroup left_sole() {
    SoftGroup out{.part = uint32_t(Garment::soles), .seam = 0.004f};
    out.pieces.push_back(cone({0.092f, 0.024f, -0.024f}, 0.060f, {0.099f, 0.024f, 0.122f}, 0.062f));
    out.cuts.push_back({{0, -1, 0}, 0, 0.012f});
    out.cuts.push_back({{0, 1, 0}, 0.026f, 0.008f});
    return out;
}

SoftGroup jumper() {
    SoftGroup out{.part = uint32_t(Garment::jumper), .seam = 0.008f};
    out.pieces.push_back(cone({-0.062f, 0.80f, -0.010f}, 0.132f, {0.062f, 0.80f, -0.010f}, 0.132f, {1, 1, 1.04f}));
    out.pieces.push_back(blended(ball({0, 0.90f, 0.022f}, 0.130f), 0.06f));
    out.pieces.push_back(blended(cone({-0.055f, 1.03f, 0}, 0.118f, {0.055f, 1.03f, 0}, 0.118f, {1, 1, 1.08f}), 0.08f));
    add_both(out,
             blended(cone({0, 1.10f, -0.006f}, 0.092f, joint_position(Joint::left_arm) + vec3(-0.02f, 0, 0), 0.070f),
                     0.05f));
    out.cuts.push_back({{0, -1, 0}, -0.762f, 0.016f});
    return out;
}

SoftGroup left_sleeve() {
    SoftGroup out{.part = uint32_t(Garment::jumper), .seam = 0.055f};
    const vec3 shoulder = joint_position(Joint::left_arm), elbow = joint_position(Joint::left_forearm),
               wrist = joint_position(Joint::left_hand);
    out.pieces.push_back(cone(shoulder, 0.068f, elbow, 0.056f));
    out.pieces.push_back(blended(cone(elbow, 0.056f, wrist, 0.055f), 0.006f));
    const vec3 along = glm::normalize(wrist - elbow);
    out.cuts.push_back({along, glm::dot(along, wrist) - 0.012f, 0.014f});
    return out;
}

SoftGroup left_mitten() {
    SoftGroup out{.part = uint32_t(Garment::mittens)};
    const vec3 elbow = joint_position(Joint::left_forearm), wrist = joint_position(Joint::left_hand);
    const vec3 along = glm::normalize(wrist - elbow), forwards = glm::normalize(glm::cross(vec3(1, 0, 0), along));
    const vec3 inwards = glm::cross(forwards, along);
    out.pieces.push_back(cone(wrist - 0.05f * along, 0.040f, wrist + 0.02f * along, 0.040f));
    out.pieces.push_back(
        cone(wrist + 0.040f * along, 0.050f, wrist + 0.115f * along + 0.014f * inwards, 0.041f, {1.2f, 1, 1}));
    out.pieces.push_back(blended(cone(wrist + 0.025f * along + 0.03f * forwards, 0.024f,
                                      wrist + 0.080f * along + 0.062f * forwards + 0.012f * inwards, 0.021f),
                                 0.02f));
    return out;
}

SoftGroup scarf() {
    SoftGroup out{.part = uint32_t(Garment::scarf)};
    out.pieces.push_back(ring({0, 1.192f, 0.004f}, {0, 1, 0.18f}, 0.080f, 0.045f));
    out.pieces.push_back(
        blended(cone({0.05f, 1.165f, 0.105f}, 0.040f, {0.074f, 0.985f, 0.140f}, 0.043f, {1, 1, 1.6f}), 0.012f));
    out.cuts.push_back({glm::normalize(vec3(0.1f, -1, 0)), -0.965f, 0.012f});
    return out;
}

SoftGroup head() {
    SoftGroup out{.part = uint32_t(Garment::skin)};
    out.pieces.push_back(cone({0, 1.13f, -0.005f}, 0.078f, {0, 1.28f, 0}, 0.062f));
    out.pieces.push_back(ball({0, 1.405f, 0.005f}, 0.158f, {1, 1.02f, 1.05f}));
    add_both(out, blended(ball({0.068f, 1.350f, 0.050f}, 0.082f), 0.05f));
    return out;
}

SoftGroup nose_and_ears() {
    SoftGroup out{.part = uint32_t(Garment::skin), .seam = 0.018f};
    out.pieces.push_back(ball({0, 1.375f, 0.158f}, 0.024f));
    add_both(out, ball({0.158f, 1.378f, -0.004f}, 0.034f, {1.5f, 1, 1}));
    return out;
}

SoftGroup hair() {
    SoftGroup out{.part = uint32_t(Garment::hair), .seam = 0.005f};
    out.pieces.push_back(ball({0, 1.405f, -0.006f}, 0.163f, {1, 1.02f, 1.03f}));
    const vec3 ahead = glm::normalize(vec3(0, -0.75f, 1));
    out.cuts.push_back({ahead, glm::dot(ahead, vec3(0, 1.40f, 0.012f)), 0.012f});
    out.cuts.push_back({{0, -1, 0}, -1.325f, 0.02f});
    return out;
}

SoftGroup fringe() {
    SoftGroup out{.part = uint32_t(Garment::hair), .seam = 0.008f};
    out.pieces.push_back(cone({-0.04f, 1.50f, 0.135f}, 0.026f, {0.035f, 1.470f, 0.150f}, 0.012f));
    out.pieces.push_back(blended(cone({0.0f, 1.50f, 0.14f}, 0.026f, {0.065f, 1.468f, 0.138f}, 0.011f), 0.008f));
    return out;
}

/// The plane through the cap's rim: higher at the front.
constexpr vec3 cap_middle{0, 1.475f, -0.004f};
const vec3 cap_up = glm::normalize(vec3(0, 1, -0.30f));

SoftGroup cap() {
    SoftGroup out{.part = uint32_t(Garment::cap)};
    out.pieces.push_back(ball(cap_middle + vec3(0, -0.01f, 0), 0.160f));
    out.pieces.push_back(blended(ball({0, 1.545f, -0.035f}, 0.125f), 0.06f));
    out.cuts.push_back({-cap_up, glm::dot(-cap_up, cap_middle), 0.01f});
    return out;
}

SoftGroup brim() {
    SoftGroup out{.part = uint32_t(Garment::brim)};
    out.pieces.push_back(ring(cap_middle, cap_up, 0.139f, 0.036f, {1, 1, 1}));
    return out;
}

SoftGroup bobble() {
    SoftGroup out{.part = uint32_t(Garment::bobble)};
    out.pieces.push_back(ball({0, 1.695f, -0.07f}, 0.060f));
    return out;
}

}  // namespace

SoftBody walker_body() {
    SoftBody body;
    // What flows into something comes right after it: the legs into the seat, the sleeves into the jumper, nose and
    // ears into the head.
    const auto add = [&](const SoftGroup& group) { body.groups.push_back(group); };
    const auto add_pair = [&](const SoftGroup& left) { add(left), add(mirrored(left)); };
    add(seat());
    add_pair(left_leg());
    add_pair(left_boot());
    add_pair(left_sole());
    add(jumper());
    add_pair(left_sleeve());
    add_pair(left_mitten());
    for (const SoftGroup& group : {scarf(), head(), nose_and_ears(), hair(), fringe(), cap(), brim(), bobble()})
        add(group);
    for (SoftGroup& group : body.groups) group.measure();
    return body;
}

}  // namespace peelray
