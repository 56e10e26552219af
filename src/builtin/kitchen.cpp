// Many finely tessellated things on a large table, far apart compared with their size: where they are surfaces lie
// close together, and in between there is nothing.

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numeric>

#include "base/error.h"
#include "builtin/shapes.h"
#include "builtin/solids.h"

namespace peelray {
namespace {

/// A body of revolution of about `budget` triangles of equal sides. `line`: from the axis to the axis, see lathe().
Primitive turned(std::initializer_list<glm::vec2> line, uint64_t budget) {
    const std::vector<glm::vec2> points(line);
    float length = 0, area = 0;
    for (size_t i = 0; i + 1 < points.size(); i++) {
        const float piece = glm::distance(points[i], points[i + 1]);
        length += piece;
        area += kTurn * 0.5f * (points[i].x + points[i + 1].x) * piece;
    }
    // Rings with as many pieces around as make them square on average.
    const float shape = area / (length * length);
    const auto rings = std::clamp<uint64_t>(uint64_t(std::lround(std::sqrt(double(budget) / (2 * shape)))), 1,
                                            std::max<uint64_t>(1, budget / 8));
    const auto around = std::max<uint64_t>(3, uint64_t(std::lround(double(budget) / (2 * double(rings)))));
    Outline profile = smooth_line(points, uint32_t(rings) + 1);
    // Where the smooth line swings out it would leave the table, or cross the axis.
    const float lowest = std::min_element(points.begin(), points.end(), [](auto a, auto b) { return a.y < b.y; })->y;
    for (glm::vec2& p : profile) p = glm::max(p, glm::vec2(1e-4f, lowest));
    profile.front().x = profile.back().x = 0;
    return lathe(profile, uint32_t(around));
}

/// A body along a smooth path of about `budget` triangles.
Primitive drawn(std::initializer_list<glm::vec3> line, uint64_t budget,
                const std::function<CrossSection(float)>& section, const glm::vec3& up = {0, 1, 0}) {
    const std::vector<glm::vec3> points(line);
    float length = 0, girth = 0;
    for (size_t i = 0; i + 1 < points.size(); i++) length += glm::distance(points[i], points[i + 1]);
    for (int i = 0; i < 8; i++)
        girth += kTurn * 0.5f * (section(float(i) / 7).half.x + section(float(i) / 7).half.y) / 8;
    // Across, edges may be a little shorter than along.
    const auto sides = std::max(3.0, std::round(std::sqrt(double(budget) * girth / length)));
    const auto pieces = std::max(2.0, std::round((double(budget) + 4) / (2 * sides) - 1));
    return sweep(smooth_path(points, uint32_t(pieces)), uint32_t(sides), section, up);
}

std::function<CrossSection(float)> round_wire(float radius) {
    return [radius](float) { return CrossSection{glm::vec2(radius), 0}; };
}

/// One of the things: parts of a material each, whose budgets are shares of its own.
struct Thing {
    struct Part {
        Primitive shape;
        uint32_t material;
    };
    const char* name;
    std::vector<Part> parts;
};

/// What things are made of.
struct Materials {
    uint32_t steel, copper, iron, wood, dark_wood, blade;
    std::array<uint32_t, 5> china;
    std::array<uint32_t, 3> glass;
};

class Maker {
  public:
    Maker(const Materials& m, uint32_t number, uint64_t budget) : m_(m), number_(number), budget_(budget) {}

    Thing make(size_t kind);
    static constexpr size_t kinds = 12;
    /// How many triangles it should have as against others.
    static constexpr std::array<float, kinds> weights{1, 1.1f, 1.3f, 1, 0.6f, 0.9f, 1.4f, 1.2f, 0.7f, 0.9f, 0.7f, 0.8f};
    static constexpr size_t bowl = 0;

  private:
    uint64_t share(float part) const { return uint64_t(part * float(budget_)); }
    uint32_t china() const { return m_.china[number_ * 7 % 5]; }
    Thing make_bowl() {
        return {"bowl",
                {{turned({{0, 0.004f},
                          {0.035f, 0.004f},
                          {0.038f, 0},
                          {0.043f, 0},
                          {0.046f, 0.008f},
                          {0.085f, 0.034f},
                          {0.108f, 0.078f},
                          {0.110f, 0.082f},
                          {0.107f, 0.082f},
                          {0.080f, 0.038f},
                          {0.042f, 0.014f},
                          {0, 0.010f}},
                         budget_),
                  china()}}};
    }
    Thing make_cup() {
        return {"cup",
                {{turned({{0, 0.003f},
                          {0.026f, 0.003f},
                          {0.028f, 0},
                          {0.031f, 0},
                          {0.034f, 0.006f},
                          {0.040f, 0.045f},
                          {0.042f, 0.094f},
                          {0.0405f, 0.096f},
                          {0.039f, 0.094f},
                          {0.0365f, 0.045f},
                          {0.028f, 0.010f},
                          {0, 0.007f}},
                         share(0.75f)),
                  china()},
                 {drawn({{0.0395f, 0.078f, 0},
                         {0.058f, 0.083f, 0},
                         {0.072f, 0.066f, 0},
                         {0.066f, 0.040f, 0},
                         {0.0385f, 0.026f, 0}},
                        budget_ - share(0.75f),
                        [](float) {
                            return CrossSection{{0.0065f, 0.0042f}, 0.2f};
                        }),
                  china()}}};
    }
    Thing make_pan() {
        const uint32_t metal = number_ % 2 ? m_.iron : m_.copper;
        return {"pan",
                {{turned({{0, 0},
                          {0.088f, 0},
                          {0.096f, 0.003f},
                          {0.118f, 0.046f},
                          {0.120f, 0.050f},
                          {0.1175f, 0.050f},
                          {0.094f, 0.006f},
                          {0.086f, 0.0035f},
                          {0, 0.0032f}},
                         share(0.7f)),
                  metal},
                 {drawn({{0.106f, 0.036f, 0}, {0.15f, 0.050f, 0}, {0.22f, 0.066f, 0}, {0.29f, 0.070f, 0}},
                        budget_ - share(0.7f),
                        [](float t) {
                            return CrossSection{{0.007f + 0.006f * t, 0.0045f + 0.003f * std::sin(3 * t)}, 0.3f};
                        }),
                  m_.steel}}};
    }
    Thing make_pot() {
        Thing out{"pot",
                  {{turned({{0, 0},
                            {0.082f, 0},
                            {0.088f, 0.004f},
                            {0.089f, 0.115f},
                            {0.092f, 0.119f},
                            {0.092f, 0.121f},
                            {0.087f, 0.121f},
                            {0.0865f, 0.112f},
                            {0.0855f, 0.007f},
                            {0, 0.005f}},
                           share(0.45f)),
                    m_.steel},
                   {turned({{0, 0.1225f},
                            {0.0855f, 0.1225f},
                            {0.092f, 0.1225f},
                            {0.0925f, 0.124f},
                            {0.075f, 0.132f},
                            {0.02f, 0.141f},
                            {0.009f, 0.143f},
                            {0.010f, 0.152f},
                            {0.018f, 0.158f},
                            {0.016f, 0.167f},
                            {0, 0.169f}},
                           share(0.35f)),
                    m_.steel}}};
        for (const float side : {1.f, -1.f})
            out.parts.push_back({drawn({{side * 0.088f, 0.096f, 0.032f},
                                        {side * 0.106f, 0.098f, 0.03f},
                                        {side * 0.116f, 0.099f, 0},
                                        {side * 0.106f, 0.098f, -0.03f},
                                        {side * 0.088f, 0.096f, -0.032f}},
                                       share(0.1f), round_wire(0.0045f)),
                                 m_.copper});
        return out;
    }
    Thing make_fork() {
        const auto neck = [](float t) {
            return CrossSection{{0.0095f * (1 - t) * (1 - t) + 0.0042f + 0.010f * t * t * t, 0.0022f - 0.0007f * t},
                                0.5f};
        };
        Thing out{"fork",
                  {{drawn({{-0.115f, 0.0045f, 0},
                           {-0.06f, 0.009f, 0},
                           {0.01f, 0.013f, 0},
                           {0.05f, 0.0075f, 0},
                           {0.064f, 0.006f, 0}},
                          share(0.4f), neck),
                    m_.steel}}};
        for (int i = 0; i < 4; i++) {
            const float z = 0.0075f * (float(i) - 1.5f);
            add_shape(out.parts[0].shape,
                      drawn({{0.058f, 0.0066f, z},
                             {0.078f, 0.006f, z * 1.05f},
                             {0.096f, 0.0085f, z * 1.05f},
                             {0.112f, 0.0145f, z}},
                            share(0.15f), [](float t) {
                                return CrossSection{{0.0021f - 0.0013f * t * t, 0.0015f - 0.0006f * t}, 0.4f};
                            }));
        }
        return out;
    }
    Thing make_bottle() {
        return {"bottle",
                {{turned({{0, 0.012f},
                          {0.022f, 0.008f},
                          {0.032f, 0},
                          {0.036f, 0.002f},
                          {0.038f, 0.010f},
                          {0.038f, 0.155f},
                          {0.030f, 0.195f},
                          {0.0155f, 0.225f},
                          {0.0145f, 0.275f},
                          {0.0165f, 0.277f},
                          {0.0165f, 0.290f},
                          {0.0145f, 0.292f},
                          {0.0105f, 0.291f},
                          {0.0105f, 0.228f},
                          {0.026f, 0.193f},
                          {0.0345f, 0.153f},
                          {0.0345f, 0.016f},
                          {0.022f, 0.013f},
                          {0, 0.017f}},
                         budget_),
                  m_.glass[number_ % 3]}}};
    }
    Thing make_whisk() {
        Thing out{"whisk",
                  {{turned({{0, -0.002f},
                            {0.006f, 0},
                            {0.0095f, 0.02f},
                            {0.0085f, 0.07f},
                            {0.0105f, 0.118f},
                            {0.0085f, 0.128f},
                            {0, 0.13f}},
                           share(0.2f)),
                    m_.wood},
                   {Primitive{}, m_.steel}}};
        // It lies on its wires: along x.
        Primitive& handle = out.parts[0].shape;
        Primitive lying;
        add_shape(lying, handle,
                  glm::translate(glm::mat4(1), {-0.13f, 0.031f, 0}) *
                      glm::rotate(glm::mat4(1), -kTurn / 4, glm::vec3(0, 0, 1)) *
                      glm::translate(glm::mat4(1), {0, -0.02f, 0}));
        handle = std::move(lying);
        const auto loops = uint32_t(std::clamp<uint64_t>(budget_ / 120, 2, 8));
        for (uint32_t i = 0; i < loops; i++) {
            const float angle = kTurn / 2 * (float(i) + 0.5f) / float(loops), grown = 1 - 0.012f * float(i % 4);
            const auto at = [&](float x, float r) {
                return glm::vec3(x, 0.031f + r * std::cos(angle) * grown, r * std::sin(angle) * grown);
            };
            const float end = 0.138f * grown;
            add_shape(
                out.parts[1].shape,
                drawn({at(-0.035f, 0.004f), at(0.01f, 0.008f), at(0.07f, 0.025f), at(0.115f, 0.0265f), at(end, 0.010f),
                       at(end, -0.010f), at(0.115f, -0.0265f), at(0.07f, -0.025f), at(0.01f, -0.008f),
                       at(-0.035f, -0.004f)},
                      (budget_ - share(0.2f)) / loops, round_wire(0.0011f), {0, std::sin(angle), -std::cos(angle)}));
        }
        return out;
    }
    Thing make_jug() {
        return {"jug",
                {{turned({{0, 0.004f},
                          {0.042f, 0.004f},
                          {0.046f, 0},
                          {0.05f, 0.002f},
                          {0.066f, 0.05f},
                          {0.062f, 0.098f},
                          {0.042f, 0.148f},
                          {0.049f, 0.19f},
                          {0.047f, 0.192f},
                          {0.0385f, 0.148f},
                          {0.058f, 0.098f},
                          {0.061f, 0.052f},
                          {0.044f, 0.012f},
                          {0, 0.009f}},
                         share(0.8f)),
                  china()},
                 {drawn({{0.043f, 0.172f, 0},
                         {0.07f, 0.183f, 0},
                         {0.094f, 0.155f, 0},
                         {0.086f, 0.105f, 0},
                         {0.0605f, 0.074f, 0}},
                        budget_ - share(0.8f),
                        [](float t) {
                            return CrossSection{{0.0085f - 0.002f * t, 0.005f}, 0.3f};
                        }),
                  china()}}};
    }
    Thing make_spoon() {
        return {"spoon",
                {{drawn({{-0.15f, 0.006f, 0},
                         {-0.06f, 0.009f, 0},
                         {0.03f, 0.013f, 0},
                         {0.075f, 0.013f, 0},
                         {0.105f, 0.011f, 0},
                         {0.135f, 0.012f, 0}},
                        budget_,
                        [](float t) {
                            const float bowl = std::clamp((t - 0.62f) / 0.38f, 0.f, 1.f),
                                        round = std::sin(kTurn / 2 * std::pow(bowl, 0.8f));
                            return CrossSection{{0.0055f + 0.0215f * round - 0.0045f * bowl * bowl,
                                                 0.0048f + 0.003f * round - 0.004f * bowl * bowl},
                                                0.1f};
                        }),
                  m_.wood}}};
    }
    Thing make_glass() {
        return {"wine glass",
                {{turned({{0, 0.001f},
                          {0.02f, 0.0008f},
                          {0.036f, 0},
                          {0.0365f, 0.0012f},
                          {0.02f, 0.004f},
                          {0.0052f, 0.010f},
                          {0.004f, 0.045f},
                          {0.0048f, 0.082f},
                          {0.017f, 0.094f},
                          {0.035f, 0.118f},
                          {0.0385f, 0.145f},
                          {0.031f, 0.196f},
                          {0.0302f, 0.1975f},
                          {0.0292f, 0.196f},
                          {0.0366f, 0.145f},
                          {0.033f, 0.119f},
                          {0.015f, 0.0965f},
                          {0, 0.093f}},
                         budget_),
                  m_.glass[2]}}};
    }
    Thing make_dish() {
        return {"plate",
                {{turned({{0, 0.003f},
                          {0.07f, 0.003f},
                          {0.073f, 0},
                          {0.077f, 0},
                          {0.081f, 0.004f},
                          {0.098f, 0.013f},
                          {0.134f, 0.022f},
                          {0.136f, 0.0235f},
                          {0.134f, 0.0255f},
                          {0.098f, 0.017f},
                          {0.078f, 0.0085f},
                          {0, 0.0075f}},
                         budget_),
                  china()}}};
    }
    Thing make_mill() {
        return {"pepper mill",
                {{turned({{0, 0},
                          {0.027f, 0},
                          {0.029f, 0.003f},
                          {0.028f, 0.02f},
                          {0.019f, 0.06f},
                          {0.016f, 0.09f},
                          {0.021f, 0.125f},
                          {0.0225f, 0.135f},
                          {0.02f, 0.1375f},
                          {0, 0.138f}},
                         share(0.55f)),
                  m_.dark_wood},
                 {turned({{0, 0.1385f},
                          {0.016f, 0.1385f},
                          {0.0225f, 0.141f},
                          {0.0235f, 0.152f},
                          {0.019f, 0.168f},
                          {0.009f, 0.176f},
                          {0, 0.177f}},
                         share(0.3f)),
                  m_.dark_wood},
                 {turned({{0, 0.177f},
                          {0.005f, 0.1772f},
                          {0.0045f, 0.181f},
                          {0.008f, 0.187f},
                          {0.0055f, 0.194f},
                          {0, 0.1955f}},
                         budget_ - share(0.55f) - share(0.3f)),
                  m_.copper}}};
    }

    const Materials& m_;
    uint32_t number_;
    uint64_t budget_;
};

Thing Maker::make(size_t kind) {
    using Make = Thing (Maker::*)();
    constexpr Make all[kinds] = {&Maker::make_bowl,  &Maker::make_cup,   &Maker::make_pot,   &Maker::make_bottle,
                                 &Maker::make_fork,  &Maker::make_pan,   &Maker::make_whisk, &Maker::make_jug,
                                 &Maker::make_spoon, &Maker::make_glass, &Maker::make_dish,  &Maker::make_mill};
    return (this->*all[kind])();
}

Materials add_materials(SceneBuilder& build) {
    const auto plain = [&](const char* name, const glm::vec3& color, float roughness, bool is_metal) {
        Material out = is_metal ? metal(name, color) : matte(name, color);
        out.roughness = roughness;
        return build.material(out);
    };
    const auto of_glass = [&](const char* name, const glm::vec3& tint) {
        return build.material(glass(name, tint, 0.004f, 0.006f));
    };
    Materials m;
    m.steel = plain("steel", {0.80f, 0.81f, 0.83f}, 0, true);
    m.copper = plain("copper", {0.95f, 0.62f, 0.44f}, 0, true);
    m.iron = plain("cast iron", {0.09f, 0.09f, 0.095f}, 0.35f, false);
    m.wood = plain("beech", {0.66f, 0.45f, 0.26f}, 0.6f, false);
    m.dark_wood = plain("walnut", {0.17f, 0.085f, 0.04f}, 0.25f, false);
    const glm::vec3 glazes[] = {{0.86f, 0.85f, 0.81f},
                                {0.05f, 0.20f, 0.42f},
                                {0.70f, 0.14f, 0.07f},
                                {0.80f, 0.56f, 0.12f},
                                {0.10f, 0.36f, 0.30f}};
    const char* names[] = {"white china", "blue china", "red china", "yellow china", "green china"};
    for (size_t i = 0; i < m.china.size(); i++) m.china[i] = plain(names[i], glazes[i], 0, false);
    m.glass = {of_glass("green glass", {0.35f, 0.72f, 0.42f}), of_glass("brown glass", {0.66f, 0.36f, 0.12f}),
               of_glass("clear glass", {0.93f, 0.97f, 0.96f})};
    return m;
}

}  // namespace

Scene make_kitchen(uint64_t triangles) {
    const std::string name = fmt::format("builtin:kitchen:{}", triangles);
    SceneBuilder build(name.c_str());
    constexpr uint32_t columns = 8, rows = 6;
    constexpr float apart = 0.46f;
    Material top = matte("table", glm::vec3(1));
    top.roughness = 0;
    top.base_color_texture = build.tiles(2, 0xC4CCD2, 0xB2BCC4, true);
    build.add("table", parallelogram({-3, 0, 2.4f}, {6, 0, 0}, {0, 0, -4.8f}, 8), build.material(top));
    const Materials materials = add_materials(build);

    // Fewer things where there are too few triangles for all of them.
    const auto count = uint32_t(std::clamp<uint64_t>(triangles / 200, 1, columns * rows));
    std::vector<size_t> kinds;
    for (uint32_t i = 0; i < count; i++)
        kinds.push_back(i + 1 == count ? Maker::bowl : (i + 1 + i / Maker::kinds * 5) % Maker::kinds);
    float weight = 0;
    for (const size_t kind : kinds) weight += Maker::weights[kind];
    Random random(3);
    uint64_t made = 0;
    for (uint32_t i = 0; i < count; i++) {
        // Nearest to the camera's middle first; what one has too many another has less.
        const uint64_t budget = std::max<uint64_t>(
            8, uint64_t(double(triangles - std::min(made, triangles)) * Maker::weights[kinds[i]] / weight));
        weight -= Maker::weights[kinds[i]];
        const uint32_t cell = count < columns * rows ? (i * 5 + 27) % (columns * rows) : i;
        const float x = apart * (float(cell % columns) - 0.5f * (columns - 1)) + random.between(-0.12f, 0.12f),
                    z = apart * (float(cell / columns) - 0.5f * (rows - 1)) + random.between(-0.12f, 0.12f);
        const glm::mat4 place =
            glm::rotate(glm::translate(glm::mat4(1), {x, 0.0006f, z}), random.between(0, kTurn), glm::vec3(0, 1, 0));
        Thing thing = Maker(materials, i, budget).make(kinds[i]);
        for (Thing::Part& part : thing.parts) {
            made += part.shape.triangles.size();
            build.add(fmt::format("{} {}", thing.name, i).c_str(), finished(std::move(part.shape)), part.material,
                      place);
        }
    }
    build.camera({0.25f, 0.78f, 2.05f}, {0.02f, 0.0f, 0.5f}, 42);
    Scene scene = build.take();
    scene.notes.push_back(fmt::format("the things have {} triangles, the table 2", made));
    return scene;
}

}  // namespace peelray
