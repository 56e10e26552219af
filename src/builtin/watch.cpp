#include "builtin/watch.h"

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "builtin/solids.h"

namespace peelray {

namespace {

glm::mat4 moved(const glm::vec3& by) {
    return glm::translate(glm::mat4(1), by);
}

glm::mat4 turned(float degrees, const glm::vec3& axis = {0, 1, 0}) {
    return glm::rotate(glm::mat4(1), glm::radians(degrees), axis);
}

/// Two flanks that bend inwards towards a narrower tip.
Outline toothed(const GearShape& g) {
    // Place in the tooth's pitch, and height.
    constexpr glm::vec2 tooth[] = {{0.22f, 0}, {0.28f, 0.45f}, {0.35f, 0.8f},  {0.44f, 1},
                                   {0.56f, 1}, {0.65f, 0.8f},  {0.72f, 0.45f}, {0.78f, 0}};
    Outline out;
    for (uint32_t i = 0; i < g.teeth; i++)
        for (const glm::vec2& p : tooth) {
            const float angle = kTurn * (float(i) + p.x) / float(g.teeth), r = g.radius - g.tooth * (1 - p.y);
            out.emplace_back(r * std::cos(angle), r * std::sin(angle));
        }
    return out;
}

/// Between two spokes, from the hub to the rim.
Outline window(const GearShape& g, uint32_t spoke) {
    const float outer = g.radius - g.tooth - g.rim, inner = g.hub, share = kTurn / float(g.spokes);
    const float from = share * float(spoke), to = from + share;
    Outline out;
    const auto arc = [&](float r, float a, float b, uint32_t steps) {
        for (uint32_t i = 0; i <= steps; i++) {
            const float angle = a + (b - a) * float(i) / float(steps);
            out.emplace_back(r * std::cos(angle), r * std::sin(angle));
        }
    };
    const auto half = [&](float r) { return std::asin(0.5f * g.spoke / r); };
    arc(outer, from + half(outer), to - half(outer), 14);
    arc(inner, to - half(inner), from + half(inner), 6);
    return out;
}

}  // namespace

Primitive gear(const GearShape& g) {
    std::vector<Outline> holes{circle({0, 0}, g.bore, 20)};
    for (uint32_t i = 0; i < g.spokes; i++) holes.push_back(window(g, i));
    return plate(toothed(g), holes, g.bottom, g.bottom + g.thickness, g.bevel);
}

namespace {

/// A turned pin: (radius, y) from the axis below to the axis above.
Primitive turned_pin(std::initializer_list<glm::vec2> profile, uint32_t segments = 32) {
    return lathe(std::vector<glm::vec2>(profile), segments);
}

/// A screw whose head's top is at y = top.
Primitive screw(float radius, float top) {
    const float slot = 0.22f * radius, height = 0.55f * radius;
    Primitive out = turned_pin({{0, top - height - 1.2f},
                                {0.5f * radius, top - height - 1.2f},
                                {0.5f * radius, top - height},
                                {radius, top - height},
                                {radius, top - 0.55f * height},
                                {0, top - 0.55f * height}},
                               28);
    // The head's upper part is two halves beside the slot.
    for (const float side : {1.f, -1.f}) {
        Outline half;
        const float from = std::asin(slot / radius);
        for (uint32_t i = 0; i <= 20; i++) {
            const float angle = from + (0.5f * kTurn - 2 * from) * float(i) / 20;
            half.push_back(side * radius * glm::vec2(std::cos(angle), std::sin(angle)) * 0.985f);
        }
        add_shape(out, plate(half, {}, top - 0.8f * height, top, 0.12f * height));
    }
    return out;
}

/// A ruby in a bridge: a ring with a cup for oil.
Primitive jewel(float radius, float top) {
    std::vector<glm::vec2> profile{{0.14f * radius, top - 0.5f}, {radius, top - 0.5f}, {radius, top - 0.08f}};
    for (int i = 1; i <= 6; i++) {
        const float a = kTurn / 4 * float(i) / 6;
        profile.emplace_back(radius * (0.92f + 0.08f * std::cos(a)), top - 0.08f + 0.08f * std::sin(a));
    }
    for (int i = 0; i <= 6; i++) {
        const float a = kTurn / 4 * float(i) / 6;
        profile.emplace_back(radius * (0.75f - 0.61f * std::sin(a)), top - 0.28f * (1 - std::cos(a)));
    }
    return lathe(profile, 36, true);
}

/// A bar with round ends through points: the outline of a bridge. Its width changes from end to end.
Outline bar(const glm::vec2& a, float ra, const glm::vec2& b, float rb, uint32_t steps = 16) {
    const glm::vec2 along = glm::normalize(b - a), across(-along.y, along.x);
    const float lean = std::asin((ra - rb) / glm::distance(a, b));
    Outline out;
    const auto arc = [&](const glm::vec2& centre, float radius, float from, float to) {
        for (uint32_t i = 0; i <= steps; i++) {
            const float angle = from + (to - from) * float(i) / float(steps);
            out.push_back(centre + radius * (std::cos(angle) * along + std::sin(angle) * across));
        }
    };
    const float q = kTurn / 4;
    arc(b, rb, lean - q, q - lean);
    arc(a, ra, q - lean, 3 * q + lean);
    return out;
}

/// All that is made of one material.
struct Parts {
    Primitive gold, brass, plate, steel, blued, ruby, enamel, ink, polished;
};

/// Where the wheels turn, (x, -z), and how high; they mesh with the pinions of the next.
struct Axle {
    glm::vec2 at;
    float bottom, top;  ///< of the arbor
};
constexpr Axle kBarrel{{-8.3f, 5.9f}, 3.2f, 7.3f}, kCentre{{0, 0}, 3.2f, 11.6f}, kThird{{5.5f, 5.4f}, 3.2f, 7.6f},
    kFourth{{9.2f, 0.4f}, 3.2f, 9.9f}, kEscape{{11.1f, -4.65f}, 3.2f, 7.6f}, kBalance{{2.6f, -10.6f}, 3.2f, 9.6f};

glm::mat4 at(const Axle& axle, float degrees = 0) {
    return moved({axle.at.x, 0, -axle.at.y}) * turned(degrees);
}

void add_arbor(Parts& parts, const Axle& axle, float radius, float pinion_bottom, float pinion_top, uint32_t leaves,
               float pinion_radius) {
    add_shape(parts.polished,
              turned_pin({{0, axle.bottom},
                          {0.6f * radius, axle.bottom},
                          {0.6f * radius, axle.bottom + 0.4f},
                          {radius, axle.bottom + 0.4f},
                          {radius, axle.top - 0.4f},
                          {0.55f * radius, axle.top - 0.35f},
                          {0.45f * radius, axle.top},
                          {0, axle.top}},
                         20),
              at(axle));
    if (leaves > 0)
        add_shape(parts.polished,
                  gear({.teeth = leaves,
                        .radius = pinion_radius,
                        .tooth = 0.45f * pinion_radius,
                        .bore = 0.9f * radius,
                        .spokes = 0,
                        .bottom = pinion_bottom,
                        .thickness = pinion_top - pinion_bottom,
                        .bevel = 0.04f}),
                  at(axle, 7));
}

void add_train(Parts& parts) {
    // The barrel with its ratchet.
    add_shape(parts.brass,
              gear({.teeth = 84,
                    .radius = 8.05f,
                    .tooth = 0.45f,
                    .bore = 1.2f,
                    .spokes = 0,
                    .bottom = 3.5f,
                    .thickness = 0.8f}),
              at(kBarrel));
    add_shape(parts.brass,
              turned_pin({{0, 4.2f},
                          {7.2f, 4.2f},
                          {7.2f, 5.35f},
                          {7.0f, 5.55f},
                          {5.6f, 5.55f},
                          {5.5f, 5.45f},
                          {2.6f, 5.45f},
                          {2.5f, 5.55f},
                          {0, 5.55f}},
                         120),
              at(kBarrel));
    add_shape(parts.steel,
              gear({.teeth = 56,
                    .radius = 5.2f,
                    .tooth = 0.4f,
                    .bore = 0.9f,
                    .spokes = 0,
                    .bottom = 5.7f,
                    .thickness = 0.5f,
                    .bevel = 0.05f}),
              at(kBarrel));
    add_arbor(parts, kBarrel, 1.0f, 0, 0, 0, 0);
    add_shape(parts.brass, gear({.teeth = 80, .radius = 6.7f, .bottom = 5.9f}), at(kCentre, 11));
    add_arbor(parts, kCentre, 0.55f, 3.5f, 4.6f, 12, 2.35f);
    add_shape(parts.brass, gear({.teeth = 70, .radius = 5.3f, .tooth = 0.32f, .bottom = 4.6f}), at(kThird, 4));
    add_arbor(parts, kThird, 0.42f, 5.4f, 6.6f, 8, 1.25f);
    add_shape(parts.brass,
              gear({.teeth = 64,
                    .radius = 4.7f,
                    .tooth = 0.3f,
                    .rim = 0.55f,
                    .hub = 0.9f,
                    .bottom = 6.5f,
                    .thickness = 0.34f}),
              at(kFourth, 30));
    add_arbor(parts, kFourth, 0.38f, 4.1f, 5.3f, 8, 1.15f);
}

/// The escape wheel, with few long teeth that lean, and the pallets that hold and release it.
void add_escapement(Parts& parts) {
    Outline club;
    for (uint32_t i = 0; i < 15; i++)
        for (const glm::vec2& p : {glm::vec2(0.0f, 2.45f),
                                   {0.22f, 2.5f},
                                   {0.55f, 3.1f},
                                   {0.68f, 3.38f},
                                   {0.9f, 3.25f},
                                   {0.82f, 3.0f},
                                   {0.8f, 2.55f}}) {
            const float angle = kTurn * (float(i) + p.x) / 15;
            club.push_back(p.y * glm::vec2(std::cos(angle), std::sin(angle)));
        }
    std::vector<Outline> holes{circle({0, 0}, 0.3f, 16)};
    for (uint32_t i = 0; i < 4; i++)
        holes.push_back(
            circle(1.42f * glm::vec2(std::cos(kTurn / 4 * float(i)), std::sin(kTurn / 4 * float(i))), 0.62f, 22));
    add_shape(parts.polished, plate(club, holes, 5.3f, 5.62f, 0.03f), at(kEscape));
    add_arbor(parts, kEscape, 0.36f, 6.45f, 7.0f, 7, 1.0f);
    // The pallets, and their fork towards the balance.
    const glm::vec2 pallets = glm::mix(kEscape.at, kBalance.at, 0.46f),
                    along = glm::normalize(kBalance.at - kEscape.at), across(-along.y, along.x);
    add_shape(parts.steel,
              plate(bar(pallets - 2.6f * across, 0.45f, pallets + 2.6f * across, 0.45f), {}, 5.8f, 6.15f, 0.05f));
    add_shape(parts.steel, plate(bar(pallets, 0.7f, pallets + 3.4f * along, 0.3f), {}, 6.0f, 6.3f, 0.05f));
    for (const float side : {-2.6f, 2.6f})
        add_shape(parts.ruby, bevelled_box({-0.28f, 5.2f, -0.6f}, {0.28f, 6.0f, 0.6f}, 0.04f),
                  moved({(pallets + side * across).x, 0, -(pallets + side * across).y}) * turned(40));
    add_shape(parts.polished, turned_pin({{0, 3.2f}, {0.35f, 3.2f}, {0.35f, 6.8f}, {0, 6.8f}}, 16),
              moved({pallets.x, 0, -pallets.y}));
}

void add_balance(Parts& parts) {
    constexpr float inner = 5.6f, outer = 6.5f, low = 7.1f, high = 7.9f;
    const std::vector<glm::vec2> rim{{inner, low + 0.1f},  {inner + 0.1f, low},  {outer - 0.1f, low},
                                     {outer, low + 0.1f},  {outer, high - 0.1f}, {outer - 0.1f, high},
                                     {inner + 0.1f, high}, {inner, high - 0.1f}};
    add_shape(parts.gold, lathe(rim, 160, true), at(kBalance));
    for (const float degrees : {20.f, 140.f, 260.f})
        add_shape(parts.gold, bevelled_box({0.4f, 7.25f, -0.35f}, {inner + 0.2f, 7.6f, 0.35f}, 0.06f),
                  at(kBalance, degrees));
    add_shape(parts.gold, turned_pin({{0, 7.05f}, {1.0f, 7.05f}, {1.1f, 7.15f}, {1.1f, 7.7f}, {1.0f, 7.8f}, {0, 7.8f}}),
              at(kBalance));
    for (uint32_t i = 0; i < 18; i++) {
        Primitive head = turned_pin(
            {{0, -0.5f}, {0.2f, -0.5f}, {0.2f, 0.12f}, {0.42f, 0.12f}, {0.42f, 0.72f}, {0.36f, 0.78f}, {0, 0.78f}}, 18);
        add_shape(parts.gold, head, at(kBalance, 20 * float(i) + 7) * moved({outer, 7.5f, 0}) * turned(-90, {0, 0, 1}));
    }
    std::vector<glm::vec3> spring;
    constexpr int steps = 480;
    for (int i = 0; i <= steps; i++) {
        const float share = float(i) / steps, angle = kTurn * 9 * share, r = 0.85f + 3.3f * share;
        spring.emplace_back(r * std::cos(angle), 8.35f, r * std::sin(angle));
    }
    add_shape(parts.blued,
              sweep(spring, 4,
                    [](float) {
                        return CrossSection{{0.055f, 0.16f}, 1};
                    },
                    {0, 1, 0}),
              at(kBalance));
    add_arbor(parts, kBalance, 0.4f, 0, 0, 0, 0);
    add_shape(parts.polished, turned_pin({{0, 8.1f}, {0.75f, 8.1f}, {0.75f, 8.6f}, {0, 8.6f}}), at(kBalance));
}

/// A bridge with a jewel over an axle and a screw near the case.
void add_bridge(Parts& parts, const Axle& over, float head, const glm::vec2& foot, float foot_radius, float bottom,
                float top) {
    const std::vector<Outline> holes{circle(over.at, 0.95f, 36)};
    add_shape(parts.steel, plate(bar(foot, foot_radius, over.at, head, 22), holes, bottom, top, 0.14f));
    // A gold setting around the stone.
    const glm::mat4 here = at(over);
    add_shape(parts.gold,
              lathe(std::vector<glm::vec2>{{0.6f, bottom + 0.1f},
                                           {0.9f, bottom + 0.1f},
                                           {0.9f, top + 0.02f},
                                           {0.84f, top + 0.07f},
                                           {0.68f, top + 0.07f},
                                           {0.6f, top}},
                    40, true),
              here);
    add_shape(parts.ruby, jewel(0.57f, top - 0.05f), here);
    const glm::mat4 there = moved({foot.x, 0, -foot.y});
    add_shape(parts.blued, screw(0.95f, top + 0.5f), there * turned(37 * foot.x));
    // It stands on a pillar, between the plate and itself.
    add_shape(parts.brass,
              turned_pin(
                  {{0, 3.25f}, {0.8f * foot_radius, 3.25f}, {0.8f * foot_radius, bottom - 0.02f}, {0, bottom - 0.02f}}),
              there);
}

void add_plates(Parts& parts) {
    std::vector<Outline> holes;
    for (const Axle& axle : {kThird, kFourth, kEscape, kBarrel}) holes.push_back(circle(axle.at, 0.55f, 24));
    add_shape(parts.plate, plate(circle({0, 0}, 20.1f, 180), holes, 2.15f, 3.15f, 0.12f));
    add_bridge(parts, kBarrel, 2.2f, {-14.9f, 9.6f}, 2.0f, 6.4f, 7.2f);
    add_bridge(parts, kThird, 1.6f, {9.6f, 14.3f}, 1.7f, 7.0f, 7.7f);
    add_bridge(parts, kEscape, 1.5f, {17.2f, -5.6f}, 1.5f, 7.0f, 7.7f);
    add_bridge(parts, kBalance, 2.0f, {-8.9f, -15.0f}, 2.4f, 8.9f, 9.7f);
    for (const float degrees : {25.f, 78.f, 158.f, 212.f, 285.f, 330.f})
        add_shape(parts.blued, screw(0.8f, 3.6f), turned(degrees) * moved({18.4f, 0, 0}) * turned(3 * degrees));
}

/// A hand along -z, of length `length`, leaf-shaped with an eye.
Primitive hand(float length, float width, float bottom, float hub) {
    Outline outline;
    const auto side = [&](float sign, int from, int to, int step) {
        for (int i = from; i != to; i += step) {
            const float share = float(i) / 24;
            const float leaf = width * (0.16f + 0.84f * std::pow(std::sin(0.5f * kTurn * std::pow(share, 0.75f)), 2.f));
            outline.emplace_back(sign * std::max(leaf, 0.06f), hub * 0.9f + (length - hub) * share);
        }
    };
    side(1, 0, 25, 1);
    outline.emplace_back(0, length);
    side(-1, 24, -1, -1);
    const std::vector<Outline> eye{circle({0, 0.42f * length}, 0.45f * width, 24)};
    Primitive out = plate(outline, eye, bottom, bottom + 0.22f, 0.05f);
    add_shape(out,
              lathe(
                  std::vector<glm::vec2>{
                      {0.45f, bottom - 0.05f}, {hub, bottom - 0.05f}, {hub, bottom + 0.24f}, {0.45f, bottom + 0.3f}},
                  40, true));
    return out;
}

void add_dial(Parts& parts) {
    add_shape(
        parts.enamel,
        lathe(
            std::vector<glm::vec2>{
                {16.1f, 9.95f}, {20.15f, 9.95f}, {20.15f, 10.3f}, {20.05f, 10.4f}, {16.2f, 10.4f}, {16.1f, 10.3f}},
            180, true));
    add_shape(
        parts.polished,
        lathe(std::vector<glm::vec2>{{15.75f, 9.9f}, {16.05f, 9.9f}, {16.05f, 10.5f}, {15.9f, 10.62f}, {15.75f, 10.5f}},
              180, true));
    for (uint32_t i = 0; i < 60; i++) {
        const glm::mat4 there = turned(-6 * float(i));
        if (i % 5 != 0) {
            add_shape(parts.ink, turned_pin({{0, 10.35f}, {0.13f, 10.35f}, {0.13f, 10.44f}, {0, 10.48f}}, 12),
                      there * moved({0, 0, -19.35f}));
            continue;
        }
        // Batons, two at the quarters.
        for (const float x : i % 15 == 0 ? std::vector<float>{-0.45f, 0.45f} : std::vector<float>{0})
            add_shape(parts.blued, bevelled_box({x - 0.27f, 10.3f, -19.6f}, {x + 0.27f, 10.75f, -16.8f}, 0.12f), there);
    }
    // Four feet hold the ring.
    for (const float degrees : {45.f, 135.f, 225.f, 315.f})
        add_shape(parts.brass, turned_pin({{0, 3.2f}, {0.7f, 3.2f}, {0.7f, 9.93f}, {0, 9.93f}}, 24),
                  turned(degrees + 3) * moved({19.0f, 0, 0}));
    // Eight minutes past ten, as in every catalogue.
    add_shape(parts.blued, hand(10.6f, 1.0f, 11.05f, 1.15f), turned(-304));
    add_shape(parts.blued, hand(15.4f, 0.75f, 11.45f, 0.95f), turned(-49));
    add_shape(parts.polished, turned_pin({{0, 11.4f}, {0.42f, 11.4f}, {0.42f, 11.85f}, {0.3f, 12.0f}, {0, 12.05f}}));
    add_shape(parts.blued, hand(3.6f, 0.3f, 9.6f, 0.5f), at(kFourth, -140));
    add_shape(parts.enamel,
              lathe(std::vector<glm::vec2>{{3.3f, 8.9f}, {4.5f, 8.9f}, {4.5f, 9.15f}, {3.3f, 9.15f}}, 90, true),
              at(kFourth));
    for (uint32_t i = 0; i < 12; i++)
        add_shape(parts.ink, bevelled_box({-0.06f, 9.1f, -4.35f}, {0.06f, 9.22f, -3.6f}, 0.02f),
                  at(kFourth, 30 * float(i)));
    add_shape(parts.polished, plate(bar({-4.4f, 0}, 0.4f, {4.4f, 0}, 0.4f), {}, 8.35f, 8.85f, 0.05f), at(kFourth, 62));
}

void add_case(Parts& parts) {
    std::vector<glm::vec2> profile{{0, 0.05f}, {17, 0.05f}};
    const glm::vec2 bulge[] = {{19.5f, 0.35f}, {22.3f, 1.9f}, {23.4f, 4.6f}, {23.3f, 7.2f}, {22.3f, 9.0f}};
    const Outline side = smooth_line(bulge, 22);
    profile.insert(profile.end(), side.begin(), side.end());
    for (const glm::vec2& p : {glm::vec2(22.3f, 9.25f),
                               {22.7f, 9.4f},
                               {22.9f, 9.8f},
                               {22.75f, 10.6f},
                               {22.2f, 11.3f},
                               {21.5f, 11.55f},
                               {20.9f, 11.4f},
                               {20.3f, 10.8f},
                               {20.25f, 2.1f},
                               {0, 2.1f}})
        profile.push_back(p);
    add_shape(parts.gold, lathe(profile, 160));
    // The lid stands open behind 12 o'clock.
    std::vector<glm::vec2> lid;
    const glm::vec2 inside[] = {{0, 0}, {12, 0.35f}, {20.6f, 1.5f}, {21.6f, 2.0f}},
                    outside[] = {{22.7f, 1.7f}, {21.6f, 0.6f}, {12, -0.75f}, {0, -1.15f}};
    const Outline in = smooth_line(inside, 20), out = smooth_line(outside, 20);
    lid.assign(out.rbegin(), out.rend());
    for (auto p = in.rbegin(); p != in.rend(); ++p) lid.push_back(*p);
    lid.front().x = lid.back().x = 0;
    const glm::mat4 hinge = moved({0, 10.2f, -23.9f}) * turned(97, {1, 0, 0}) * moved({0, -0.3f, -22.9f});
    add_shape(parts.gold, lathe(lid, 160), hinge);
    for (const float x : {-3.3f, -1.1f, 1.1f, 3.3f})
        add_shape(parts.gold, turned_pin({{0, -1}, {0.75f, -1}, {0.85f, -0.9f}, {0.85f, 0.9f}, {0.75f, 1}, {0, 1}}),
                  moved({x, 10.0f, -23.9f}) * turned(90, {0, 0, 1}));
    // Neck, crown and bow at 3 o'clock.
    add_shape(parts.gold,
              turned_pin({{0, 22.5f}, {3.6f, 22.5f}, {3.2f, 24.2f}, {2.5f, 25.2f}, {2.5f, 26.4f}, {0, 26.4f}}, 48),
              moved({0, 5.6f, 0}) * turned(-90, {0, 0, 1}));
    add_shape(parts.gold,
              gear({.teeth = 40,
                    .radius = 3.3f,
                    .tooth = 0.3f,
                    .bore = 0.8f,
                    .spokes = 0,
                    .bottom = 26.7f,
                    .thickness = 3.4f,
                    .bevel = 0.25f}),
              moved({0, 5.6f, 0}) * turned(-90, {0, 0, 1}));
    std::vector<glm::vec3> bow;
    for (int i = 0; i <= 60; i++) {
        const float angle = kTurn * (0.5f + 0.115f + 0.77f * float(i) / 60);
        bow.emplace_back(29.6f + 6.4f * std::cos(angle), 5.6f, 6.4f * std::sin(angle));
    }
    add_shape(parts.gold, wire(bow, 20, 0.95f));
}

void add_chain(Parts& parts) {
    const glm::vec3 way[] = {{37.2f, 1.65f, 2.5f}, {47, 1.65f, 10},   {50, 1.65f, 24},   {38, 1.65f, 33},
                             {20, 1.65f, 33.5f},   {-2, 1.65f, 35},   {-24, 1.65f, 36},  {-42, 1.65f, 28},
                             {-52, 1.65f, 8},      {-60, 1.65f, -20}, {-52, 1.65f, -52}, {-70, 1.65f, -80}};
    float length = 0;
    for (size_t i = 0; i + 1 < std::size(way); i++) length += glm::distance(way[i], way[i + 1]);
    // Links overlap by twice the wire.
    const auto links = uint32_t(1.03f * length / 4.05f);
    const std::vector<glm::vec3> path = smooth_path(way, links);
    std::vector<glm::vec3> oval;
    for (int i = 0; i < 20; i++) {
        const float angle = kTurn * float(i) / 20;
        oval.emplace_back(
            1.25f * std::copysign(1.f, std::cos(angle)) * (std::abs(std::cos(angle)) > 0.02f) + 1.25f * std::cos(angle),
            0, 1.35f * std::sin(angle));
    }
    const Primitive link = wire(oval, 8, 0.44f, true);
    for (uint32_t i = 0; i < links; i++) {
        const glm::vec3 along = path[i + 1] - path[i], middle = 0.5f * (path[i] + path[i + 1]);
        const float heading = glm::degrees(std::atan2(-along.z, along.x));
        add_shape(parts.steel, link, moved(middle) * turned(heading) * turned(i % 2 ? 45.f : -45.f, {1, 0, 0}));
    }
}

Material plain_metal(const char* name, const glm::vec3& color, float roughness) {
    Material out = metal(name, color);
    out.roughness = roughness;
    return out;
}

}  // namespace

void add_watch(SceneBuilder& build, const glm::mat4& place) {
    Parts parts;
    add_case(parts);
    add_plates(parts);
    add_train(parts);
    add_escapement(parts);
    add_balance(parts);
    add_dial(parts);
    add_chain(parts);
    const auto add = [&](const char* name, Primitive& shape, const Material& material, float crease = 35) {
        build.add(name, finished(std::move(shape), crease), build.material(material), place);
    };
    add("watch: gold", parts.gold, plain_metal("polished gold", {1.0f, 0.76f, 0.38f}, 0));
    add("watch: brass", parts.brass, plain_metal("brushed brass", {0.90f, 0.72f, 0.42f}, 0.3f));
    add("watch: plate", parts.plate, plain_metal("rhodium", {0.87f, 0.86f, 0.84f}, 0.4f));
    add("watch: steel", parts.steel, plain_metal("brushed steel", {0.78f, 0.79f, 0.80f}, 0.14f));
    add("watch: polished steel", parts.polished, plain_metal("polished steel", {0.86f, 0.87f, 0.88f}, 0));
    add("watch: blued steel", parts.blued, plain_metal("blued steel", {0.09f, 0.16f, 0.52f}, 0.08f));
    Material ruby = matte("ruby", {0.62f, 0.015f, 0.07f}), enamel = matte("enamel", {0.90f, 0.89f, 0.85f}),
             ink = matte("ink", {0.03f, 0.03f, 0.04f});
    ruby.roughness = 0;
    enamel.roughness = 0.05f;
    ink.roughness = 0.4f;
    add("watch: jewels", parts.ruby, ruby);
    add("watch: dial", parts.enamel, enamel);
    add("watch: minutes", parts.ink, ink);
}

}  // namespace peelray
