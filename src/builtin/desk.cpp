// A desk in a room, and on it a pocket watch: from four metres of room to tenths of a millimetre of gear teeth.

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "builtin/shapes.h"
#include "builtin/solids.h"
#include "builtin/watch.h"

namespace peelray {
namespace {

// Metres; the desk's top is y = 0.
constexpr float kLeft = -1.9f, kRight = 2.1f, kFloor = -0.74f, kCeiling = 1.86f, kFront = 2.0f, kBack = -1.2f;

glm::mat4 placed(const glm::vec3& at, float degrees = 0) {
    return glm::rotate(glm::translate(glm::mat4(1), at), glm::radians(degrees), glm::vec3(0, 1, 0));
}

Material glossy(const char* name, const glm::vec3& color, float roughness) {
    Material out = matte(name, color);
    out.roughness = roughness;
    return out;
}

Material glowing(const char* name, const glm::vec3& radiance) {
    Material out = matte(name, glm::vec3(0.8f));
    out.emissive = radiance;
    return out;
}

float grain(float x, float y) {
    // Sines whose phases wander: lines along x that bend and thicken.
    const float wander = 0.6f * std::sin(2.1f * x + 1.3f * std::sin(3.1f * y)) + 0.25f * std::sin(7.3f * x + 9 * y);
    const float lines = std::sin(46 * y + 2.2f * wander) + 0.5f * std::sin(113 * y + 3.7f * wander) +
                        0.35f * std::sin(271 * y + 6 * wander + 1.3f * x);
    return 0.5f + 0.27f * lines;
}

/// `planks` across, each with its own tone.
Texture wood_texture(const glm::vec3& dark, const glm::vec3& light, uint32_t planks) {
    Texture texture;
    texture.name = "wood";
    texture.width = texture.height = 512;
    Random random(5 + planks);
    std::vector<float> tone, shift;
    for (uint32_t i = 0; i < planks; i++)
        tone.push_back(random.between(-0.13f, 0.13f)), shift.push_back(40 * random.next());
    for (uint32_t y = 0; y < texture.height; y++)
        for (uint32_t x = 0; x < texture.width; x++) {
            const float u = float(x) / float(texture.width), v = float(y) / float(texture.height) * float(planks);
            const auto plank = std::min(uint32_t(v), planks - 1);
            const float across = v - float(plank),
                        edge = planks > 1 && (across < 0.015f || across > 0.985f) ? 0.45f : 1;
            const float share = grain(kTurn * u + shift[plank], across * 0.9f + shift[plank]) + tone[plank];
            const glm::vec3 color = 255.f * edge * glm::mix(dark, light, glm::clamp(share, 0.f, 1.f));
            texture.texels.push_back(0xFF000000u | uint32_t(color.z) << 16 | uint32_t(color.y) << 8 |
                                     uint32_t(color.x));
        }
    return texture;
}

void add_room(SceneBuilder& build) {
    const float width = kRight - kLeft, depth = kFront - kBack, height = kCeiling - kFloor;
    Material boards = glossy("floor boards", glm::vec3(1), 0.25f);
    boards.base_color_texture = build.texture(wood_texture({0.30f, 0.19f, 0.12f}, {0.56f, 0.38f, 0.24f}, 8));
    build.add("floor", parallelogram({kLeft, kFloor, kFront}, {width, 0, 0}, {0, 0, -depth}, 2),
              build.material(boards));
    const uint32_t plaster = build.material(matte("plaster", {0.80f, 0.78f, 0.73f})),
                   paint = build.material(matte("green paint", {0.23f, 0.33f, 0.31f}));
    build.add("ceiling", parallelogram({kLeft, kCeiling, kBack}, {width, 0, 0}, {0, 0, depth}), plaster);
    build.add("back wall", parallelogram({kLeft, kFloor, kBack}, {width, 0, 0}, {0, height, 0}), paint);
    build.add("front wall", parallelogram({kRight, kFloor, kFront}, {-width, 0, 0}, {0, height, 0}), plaster);
    build.add("left wall", parallelogram({kLeft, kFloor, kFront}, {0, 0, -depth}, {0, height, 0}), plaster);
    build.add("right wall", parallelogram({kRight, kFloor, kBack}, {0, 0, depth}, {0, height, 0}), plaster);

    // A window of six panes in the left wall; behind it the sky, as a lamp of its size.
    const float low = 0.15f, high = 1.5f, near = 0.75f, far = -0.75f, x = kLeft;
    Primitive frame;
    const auto beam = [&](const glm::vec3& lower, const glm::vec3& upper) { add_shape(frame, box(lower, upper)); };
    for (const float z : {far, 0.f, near}) beam({x, low, z - 0.03f}, {x + 0.06f, high, z + 0.03f});
    // The horizontal ones are a little less deep, and so cross the others without sharing a face.
    for (const float y : {low, 0.5f * (low + high), high})
        beam({x, y - 0.03f, far - 0.05f}, {x + 0.05f, y + 0.03f, near + 0.05f});
    beam({x, low - 0.06f, far - 0.1f}, {x + 0.16f, low - 0.035f, near + 0.1f});
    build.add("window frame", std::move(frame), build.material(glossy("white paint", {0.82f, 0.82f, 0.80f}, 0.3f)));
    build.add("window", parallelogram({x + 0.01f, low, near}, {0, 0, far - near}, {0, high - low, 0}),
              build.material(glowing("sky behind the window", {3.6f, 4.3f, 5.2f})));
    // Two long lamps under the ceiling, behind the camera.
    const uint32_t tube = build.material(glowing("light panel", {5.0f, 4.5f, 3.8f}));
    for (const float at : {-0.6f, 0.9f})
        build.add("light panel", box({at, kCeiling - 0.05f, 0.5f}, {at + 0.28f, kCeiling - 0.02f, 1.7f}), tube);
}

/// A shelf of books on the back wall, and a picture.
void add_back_wall(SceneBuilder& build) {
    const uint32_t wood = build.material(glossy("shelf", {0.40f, 0.26f, 0.15f}, 0.35f));
    const float y = 0.62f, z = kBack + 0.002f;
    Primitive shelf;
    for (const float level : {0.f, 0.36f})
        add_shape(shelf, bevelled_box({-0.5f, y + level - 0.02f, z}, {1.5f, y + level, z + 0.24f}, 0.003f));
    build.add("shelf", finished(std::move(shelf)), wood);
    Random random(23);
    const glm::vec3 colors[] = {{0.45f, 0.06f, 0.05f}, {0.06f, 0.16f, 0.32f}, {0.55f, 0.40f, 0.12f},
                                {0.07f, 0.23f, 0.12f}, {0.72f, 0.66f, 0.54f}, {0.16f, 0.09f, 0.06f}};
    Primitive books[std::size(colors)];
    for (const float level : {0.f, 0.36f})
        for (float x = -0.46f; x < 1.42f;) {
            const float width = random.between(0.018f, 0.05f), height = random.between(0.2f, 0.31f),
                        depth = random.between(0.14f, 0.2f);
            add_shape(books[size_t(random.next() * 5.99f)],
                      bevelled_box({x, y + level + 0.0005f, z + 0.01f},
                                   {x + width, y + level + height, z + 0.01f + depth}, 0.002f));
            x += width + (random.next() < 0.12f ? 0.09f : 0.0015f);
        }
    for (size_t i = 0; i < std::size(colors); i++)
        build.add("books on the shelf", finished(std::move(books[i])),
                  build.material(glossy("book cloth", colors[i], 0.55f)));
    Primitive frame = plate({{-1.42f, 0.5f}, {-0.78f, 0.5f}, {-0.78f, 1.3f}, {-1.42f, 1.3f}},
                            std::vector<Outline>{{{-1.37f, 0.55f}, {-0.83f, 0.55f}, {-0.83f, 1.25f}, {-1.37f, 1.25f}}},
                            0, 0.025f, 0.005f);
    const glm::mat4 upright =
        glm::translate(glm::mat4(1), {0, 0, z}) * glm::rotate(glm::mat4(1), glm::radians(90.f), glm::vec3(1, 0, 0));
    build.add("picture frame", finished(std::move(frame)), build.material(metal("gilded frame", {0.85f, 0.66f, 0.33f})),
              upright);
    Material picture = matte("picture", glm::vec3(1));
    picture.base_color_texture = build.tiles(4, 0x6A4A28, 0xA8C8D8, true);
    build.add("picture", parallelogram({-1.38f, 0.54f, z + 0.008f}, {0.56f, 0, 0}, {0, 0.72f, 0}),
              build.material(picture));
}

void add_desk(SceneBuilder& build) {
    Material wood = glossy("walnut", glm::vec3(1), 0.18f);
    wood.base_color_texture = build.texture(wood_texture({0.17f, 0.09f, 0.05f}, {0.46f, 0.27f, 0.15f}, 1));
    const uint32_t walnut = build.material(wood);
    Primitive top = finished(bevelled_box({-0.75f, -0.035f, -0.62f}, {0.75f, 0, 0.34f}, 0.004f));
    for (const glm::vec3& p : top.positions) top.uvs.emplace_back((p.x + 0.75f) / 0.75f, (p.z + 0.62f - p.y) / 0.96f);
    build.add("desk top", std::move(top), walnut);
    Primitive frame;
    for (const float x : {-0.68f, 0.68f})
        for (const float z : {-0.55f, 0.27f})
            add_shape(frame,
                      bevelled_box({x - 0.03f, kFloor + 0.0005f, z - 0.03f}, {x + 0.03f, -0.0355f, z + 0.03f}, 0.004f));
    build.add("desk legs", finished(std::move(frame)),
              build.material(glossy("walnut legs", {0.20f, 0.11f, 0.06f}, 0.25f)));
    // A blotter of leather.
    Material leather = glossy("leather", {0.03f, 0.10f, 0.08f}, 0.75f);
    build.add(
        "blotter",
        finished(plate(rounded_rectangle({-0.27f, -0.17f}, {0.27f, 0.19f}, 0.012f, 8), {}, 0.0002f, 0.002f, 0.0007f)),
        build.material(leather));
}

void add_lamp(SceneBuilder& build, const glm::vec3& foot, float degrees) {
    const uint32_t brass = build.material(metal("lamp brass", {0.88f, 0.68f, 0.36f})),
                   green = build.material(glossy("lamp enamel", {0.02f, 0.16f, 0.10f}, 0.06f));
    Primitive stand = lathe(std::vector<glm::vec2>{{0, 0.0005f},
                                                   {0.085f, 0.0005f},
                                                   {0.09f, 0.004f},
                                                   {0.09f, 0.012f},
                                                   {0.082f, 0.018f},
                                                   {0.03f, 0.026f},
                                                   {0.014f, 0.04f},
                                                   {0.0085f, 0.06f},
                                                   {0, 0.06f}},
                            96);
    const glm::vec3 way[] = {
        {0, 0.05f, 0}, {0, 0.22f, 0}, {0.012f, 0.36f, 0.012f}, {0.07f, 0.425f, 0.07f}, {0.125f, 0.415f, 0.125f}};
    const std::vector<glm::vec3> path = smooth_path(way, 40);
    add_shape(stand, wire(path, 18, 0.0065f));
    build.add("lamp stand", finished(std::move(stand)), brass, placed(foot, degrees));
    const glm::mat4 turn = placed({0, 0, 0}, degrees);
    const glm::vec3 head = foot + glm::vec3(turn * glm::vec4(0.14f, 0.4f, 0.14f, 0));
    const glm::vec2 outer[] = {
        {0.088f, -0.075f}, {0.084f, -0.045f}, {0.06f, -0.005f}, {0.022f, 0.016f}, {0.018f, 0.034f}};
    std::vector<glm::vec2> profile = smooth_line(outer, 18);
    profile.emplace_back(0, 0.036f);
    profile.front() = {0.088f, -0.075f};
    std::vector<glm::vec2> shade{{0, 0.0f}};
    const glm::vec2 inner[] = {{0.016f, 0.002f}, {0.055f, -0.012f}, {0.0805f, -0.048f}, {0.0855f, -0.075f}};
    const Outline inside = smooth_line(inner, 18);
    shade.insert(shade.end(), inside.begin(), inside.end());
    shade.insert(shade.end(), profile.begin(), profile.end());
    const glm::mat4 tilted = placed(head, degrees) * glm::rotate(glm::mat4(1), glm::radians(14.f), glm::vec3(-1, 0, 1));
    build.add("lamp shade", finished(lathe(shade, 64)), green, tilted);
    const glm::vec3 bulb = glm::vec3(tilted * glm::vec4(0, -0.036f, 0, 1));
    // It shines by the lamp in its place: as an emitter it would be too small to be found often.
    Material glass = matte("bulb", {1.0f, 0.93f, 0.80f});
    glass.unlit = true;
    build.add("bulb", sphere(bulb, 0.022f, 8), build.material(glass));
    Light light;
    light.name = "desk lamp";
    light.kind = Light::Kind::point;
    light.color = glm::vec3(0.62f, 0.55f, 0.45f);
    light.position = bulb - glm::vec3(0, 0.03f, 0);
    light.radius = 0.006f;
    build.light(light);
}

void add_cup(SceneBuilder& build, const glm::vec3& at) {
    const uint32_t china = build.material(glossy("china", {0.86f, 0.85f, 0.82f}, 0));
    const glm::vec2 out[] = {{0.021f, 0.006f}, {0.033f, 0.016f}, {0.0405f, 0.04f}, {0.0425f, 0.066f}},
                    in[] = {{0.0398f, 0.0665f}, {0.038f, 0.042f}, {0.03f, 0.019f}, {0.018f, 0.0095f}};
    std::vector<glm::vec2> profile{{0, 0.003f}, {0.019f, 0.003f}, {0.0215f, 0.0015f}, {0.0225f, 0.002f}};
    const Outline outer = smooth_line(out, 18), inner = smooth_line(in, 18);
    profile.insert(profile.end(), outer.begin(), outer.end());
    profile.emplace_back(0.0415f, 0.0677f);
    profile.insert(profile.end(), inner.begin(), inner.end());
    profile.emplace_back(0, 0.009f);
    Primitive cup = lathe(profile, 64);
    const glm::vec3 way[] = {
        {0.0405f, 0.055f, 0}, {0.055f, 0.0585f, 0}, {0.0655f, 0.048f, 0}, {0.059f, 0.031f, 0}, {0.0375f, 0.025f, 0}};
    add_shape(cup, wire(smooth_path(way, 24), 12, 0.0036f));
    build.add("cup", finished(std::move(cup)), china, placed(at + glm::vec3(0, 0.0075f, 0), 25));
    const glm::vec2 plate[] = {{0.03f, 0.001f}, {0.045f, 0.004f}, {0.066f, 0.0125f}, {0.077f, 0.0155f}},
                    dish[] = {{0.0765f, 0.0172f}, {0.064f, 0.0152f}, {0.042f, 0.0072f}, {0.028f, 0.006f}};
    std::vector<glm::vec2> saucer{{0, 0.002f}, {0.027f, 0.002f}, {0.029f, 0.0006f}};
    const Outline below = smooth_line(plate, 14), above = smooth_line(dish, 14);
    saucer.insert(saucer.end(), below.begin(), below.end());
    saucer.insert(saucer.end(), above.begin(), above.end());
    saucer.emplace_back(0, 0.0058f);
    build.add("saucer", finished(lathe(saucer, 64)), china, placed(at));
    build.add("coffee",
              finished(lathe(std::vector<glm::vec2>{{0, 0.04f}, {0.036f, 0.04f}, {0.0383f, 0.0545f}, {0, 0.054f}}, 60)),
              build.material(glossy("coffee", {0.035f, 0.014f, 0.006f}, 0)), placed(at + glm::vec3(0, 0.0075f, 0)));
}

void add_books(SceneBuilder& build, const glm::vec3& at) {
    const uint32_t paper = build.material(matte("paper", {0.80f, 0.76f, 0.66f}));
    const glm::vec3 colors[] = {{0.10f, 0.17f, 0.36f}, {0.52f, 0.09f, 0.06f}, {0.60f, 0.47f, 0.20f}};
    float y = 0.0004f;
    for (int i = 0; i < 3; i++) {
        const float w = 0.085f - 0.011f * float(i), d = 0.12f - 0.012f * float(i), h = 0.026f + 0.006f * float(i % 2);
        const glm::mat4 here = placed(at + glm::vec3(0.004f * float(i), y, 0), 12 + 17 * float(i * i) - 22 * float(i));
        Primitive cover;
        add_shape(cover, bevelled_box({-w, 0, -d}, {w, 0.0025f, d}, 0.0006f));
        add_shape(cover, bevelled_box({-w, h - 0.0025f, -d}, {w, h, d}, 0.0006f));
        add_shape(cover,
                  bevelled_box({-w - 0.001f, 0.0006f, -d + 0.0004f}, {-w + 0.004f, h - 0.0006f, d - 0.0004f}, 0.0012f));
        build.add("book", finished(std::move(cover)), build.material(glossy("cover", colors[i], 0.35f)), here);
        Primitive pages;
        // Some sheets stand out: the edges show lines.
        constexpr int leaves = 14;
        for (int k = 0; k < leaves; k++) {
            const float low = 0.0027f + (h - 0.0054f) * float(k) / leaves,
                        high = 0.0027f + (h - 0.0054f) * (float(k) + 0.93f) / leaves,
                        in = 0.003f + 0.0006f * float((k * 7) % 5);
            add_shape(pages, bevelled_box({-w + 0.0042f, low, -d + in}, {w - in, high, d - in}, 0));
        }
        build.add("pages", finished(std::move(pages)), paper, here);
        y += h + 0.0004f;
    }
}

/// A sharpened pencil along x, its tip at the origin.
void add_pencil(SceneBuilder& build, const glm::vec3& color, float length, const glm::mat4& at) {
    constexpr float r = 0.0036f, cone = 0.021f, lead = 0.0055f;
    const glm::mat4 along = at * glm::rotate(glm::mat4(1), glm::radians(-90.f), glm::vec3(0, 0, 1));
    build.add("pencil", finished(plate(circle({0, 0}, r, 6), {}, cone, length, 0.0003f)),
              build.material(glossy("pencil paint", color, 0.12f)), along);
    const float share = lead / cone;
    build.add("pencil wood",
              finished(lathe(
                  std::vector<glm::vec2>{
                      {0, lead}, {0.9f * r * share, lead}, {0.9f * r, cone + 0.0002f}, {0, cone + 0.0002f}},
                  30)),
              build.material(matte("cedar", {0.66f, 0.43f, 0.24f})), along);
    build.add(
        "pencil lead",
        finished(lathe(std::vector<glm::vec2>{{0, 0}, {0.85f * r * share, lead + 0.0001f}, {0, lead + 0.0001f}}, 20)),
        build.material(glossy("graphite", {0.06f, 0.06f, 0.065f}, 0.25f)), along);
    build.add("ferrule",
              finished(lathe(std::vector<glm::vec2>{{0, length + 0.0002f},
                                                    {r, length + 0.0002f},
                                                    {r, length + 0.004f},
                                                    {1.08f * r, length + 0.005f},
                                                    {r, length + 0.006f},
                                                    {r, length + 0.012f},
                                                    {0, length + 0.012f}},
                             30)),
              build.material(metal("ferrule", {0.86f, 0.80f, 0.62f})), along);
    build.add("eraser",
              finished(lathe(std::vector<glm::vec2>{{0, length + 0.0122f},
                                                    {0.92f * r, length + 0.0122f},
                                                    {0.92f * r, length + 0.018f},
                                                    {0.6f * r, length + 0.0195f},
                                                    {0, length + 0.02f}},
                             30)),
              build.material(matte("eraser", {0.70f, 0.26f, 0.24f})), along);
}

void add_pencil_pot(SceneBuilder& build, const glm::vec3& at) {
    const glm::vec2 profile[] = {{0, 0.0005f},       {0.034f, 0.0005f}, {0.036f, 0.0025f}, {0.036f, 0.094f},
                                 {0.0345f, 0.0955f}, {0.033f, 0.094f},  {0.033f, 0.004f},  {0, 0.004f}};
    build.add("pencil pot", finished(lathe(profile, 90)), build.material(metal("steel pot", {0.80f, 0.81f, 0.83f})),
              placed(at));
    const glm::vec3 colors[] = {
        {0.78f, 0.50f, 0.04f}, {0.55f, 0.05f, 0.04f}, {0.05f, 0.15f, 0.42f}, {0.04f, 0.26f, 0.12f}};
    for (int i = 0; i < 4; i++) {
        // Its end in the pot's bottom, its side at the rim.
        const float angle = 80 * float(i) + 15, length = 0.135f + 0.012f * float(i);
        const glm::mat4 up = placed(at + glm::vec3(0, 0.0065f, 0), angle) *
                             glm::translate(glm::mat4(1), glm::vec3(-0.02f, length + 0.02f, 0)) *
                             glm::translate(glm::mat4(1), glm::vec3(0.046f * (length + 0.02f) / 0.094f, 0, 0)) *
                             glm::rotate(glm::mat4(1), glm::radians(-90.f - 26.f), glm::vec3(0, 0, 1));
        add_pencil(build, colors[i], length, up);
    }
}

}  // namespace

Scene make_desk() {
    SceneBuilder build("builtin:desk");
    add_room(build);
    add_back_wall(build);
    add_desk(build);
    add_lamp(build, {0.20f, 0, -0.30f}, -90);
    add_cup(build, {-0.17f, 0, -0.24f});
    add_books(build, {0.02f, 0, -0.36f});
    add_pencil_pot(build, {0.40f, 0, -0.36f});
    add_pencil(build, {0.78f, 0.50f, 0.04f}, 0.15f, placed({0.085f, 0.0053f, -0.018f}, 52));
    add_watch(build, placed({0, 0.0021f, 0}, 24) * glm::scale(glm::mat4(1), glm::vec3(0.001f)));
    Light ceiling;
    ceiling.name = "ceiling lamp";
    ceiling.kind = Light::Kind::point;
    ceiling.color = glm::vec3(7.5f, 7.0f, 6.2f);
    ceiling.position = {0.35f, kCeiling - 0.12f, 0.75f};
    ceiling.radius = 0.09f;
    build.light(ceiling);
    build.camera({0.017f, 0.067f, 0.066f}, {0.003f, 0.014f, -0.007f}, 46);
    return build.take();
}

}  // namespace peelray
