// Small trees as games make them: a few hundred squares, each with a spray of leaves cut out by its texture's alpha.

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

#include "builtin/shapes.h"

namespace peelray {

namespace {

constexpr float pi = std::numbers::pi_v<float>;
constexpr uint32_t texels = 128;
constexpr int sprays = 420;

/// How far inside a leaf of unit length, pointing along +x from 0, a point lies; negative: outside.
float inside_leaf(const glm::vec2& p) {
    if (p.x <= 0 || p.x >= 1) return -glm::length(p - glm::vec2(std::clamp(p.x, 0.f, 1.f), 0));
    return 0.26f * std::sin(pi * std::pow(p.x, 0.8f)) - std::abs(p.y);
}

/// A twig up the middle with leaves to both sides and one at its tip.
Texture spray_texture() {
    struct Leaf {
        glm::vec2 stem;
        float angle, length;
    };
    std::vector<Leaf> leaves{{{0.5f, 0.62f}, 90, 0.36f}};
    for (int i = 0; i < 3; ++i) {
        const float y = 0.10f + 0.19f * float(i), length = 0.44f - 0.05f * float(i);
        leaves.push_back({{0.5f, y}, 28.f + 6 * float(i), length});
        leaves.push_back({{0.5f, y + 0.07f}, 152.f - 6 * float(i), length});
    }
    Texture texture;
    texture.name = "spray of leaves";
    texture.width = texture.height = texels;
    texture.wrap_u = texture.wrap_v = Texture::Wrap::clamp;
    for (uint32_t y = 0; y < texels; ++y)
        for (uint32_t x = 0; x < texels; ++x) {
            const glm::vec2 p((float(x) + 0.5f) / texels, 1 - (float(y) + 0.5f) / texels);
            float best = p.y < 0.66f ? 0.011f - std::abs(p.x - 0.5f) : -1.f, rib = 1;
            for (const Leaf& leaf : leaves) {
                const float a = glm::radians(leaf.angle);
                const glm::vec2 q = (p - leaf.stem) / leaf.length;
                const glm::vec2 along(q.x * std::cos(a) + q.y * std::sin(a), q.y * std::cos(a) - q.x * std::sin(a));
                const float d = leaf.length * inside_leaf(along);
                if (d > best) best = d, rib = std::abs(along.y) / 0.05f;
            }
            // Alpha 0.5 lies on the outline and falls off over two texels to both sides: bilinear lookups cut smoothly.
            const float alpha = std::clamp(0.5f + 0.25f * best * texels, 0.f, 1.f);
            const float shade = 0.75f + 0.25f * std::min(rib, 1.f) - 0.2f * p.y;
            const auto channel = [&](float value) { return uint32_t(std::lround(255 * std::clamp(value, 0.f, 1.f))); };
            texture.texels.push_back(channel(alpha) << 24 | channel(0.24f * shade) << 16 | channel(0.66f * shade) << 8 |
                                     channel(0.40f * shade));
        }
    return texture;
}

/// A square that hangs on the middle of its lower side.
void add_spray(Primitive& out, const glm::vec3& stem, const glm::vec3& along, const glm::vec3& side, float size) {
    Primitive square = parallelogram(stem - side * (0.5f * size), side * size, along * size);
    const auto first = uint32_t(out.positions.size());
    out.positions.insert(out.positions.end(), square.positions.begin(), square.positions.end());
    out.normals.insert(out.normals.end(), square.normals.begin(), square.normals.end());
    for (const glm::vec2& uv : square.uvs) out.uvs.emplace_back(uv.x, 1 - uv.y);
    for (const glm::uvec3& t : square.triangles) out.triangles.push_back(t + first);
}

}  // namespace

Scene make_leaves() {
    SceneBuilder build("builtin:leaves");
    Random random(11);
    Material floor = metal("polished tiles", glm::vec3(1));
    floor.metallic = 0.8f;
    floor.base_color_texture = build.tiles(2, 0xD8DEE2, 0x8A8078, true);
    build.add("floor", parallelogram({-4, 0, 4}, {8, 0, 0}, {0, 0, -8}, 5), build.material(floor));

    Primitive wood, leaves;
    const glm::vec3 crown(0, 1.55f, 0);
    add_tube(wood, {0, -0.02f, 0}, {0.03f, 0.95f, 0.01f}, 0.09f, 0.06f, 12);
    for (int i = 0; i < 9; ++i) {
        const float a = 2.399963f * float(i), up = random.between(0.35f, 1.2f);
        const glm::vec3 tip = crown + 0.62f * glm::normalize(glm::vec3(std::cos(a), up - 0.6f, std::sin(a)));
        add_tube(wood, {0.02f, random.between(0.7f, 0.95f), 0.01f}, tip, 0.035f, 0.012f, 6);
    }
    for (int i = 0; i < sprays; ++i) {
        // Evenly over the crown's sphere by the golden angle, in its outer half.
        const float y = 1 - 2 * (float(i) + 0.5f) / sprays, a = 2.399963f * float(i), r = std::sqrt(1 - y * y);
        const glm::vec3 outwards(r * std::cos(a), y, r * std::sin(a));
        const glm::vec3 along =
            glm::normalize(outwards + glm::vec3(random.between(-0.9f, 0.9f), random.between(-0.9f, 0.6f),
                                                random.between(-0.9f, 0.9f)));
        const glm::vec3 turned(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1));
        const glm::vec3 side = glm::normalize(glm::cross(along, turned + 2.f * any_perpendicular(along)));
        add_spray(leaves, crown + outwards * (0.72f * random.between(0.5f, 0.95f)), along, side,
                  random.between(0.2f, 0.34f));
    }
    Material leaf = matte("leaves", glm::vec3(1));
    leaf.roughness = 0.6f;
    leaf.alpha_cutoff = 0.5f;
    leaf.base_color_texture = build.texture(spray_texture());
    const int trunk = build.add("trunk", std::move(wood), build.material(matte("bark", {0.20f, 0.13f, 0.08f})),
                                glm::translate(glm::mat4(1), {-0.75f, 0, 0}));
    const int tree =
        build.add("leaves", std::move(leaves), build.material(leaf), glm::translate(glm::mat4(1), {-0.75f, 0, 0}));
    // The other tree is the same, smaller and seen in a mirror.
    glm::mat4 other = glm::translate(glm::mat4(1), {1.15f, 0, -0.6f});
    other = glm::scale(glm::rotate(other, 2.1f, glm::vec3(0, 1, 0)), {-0.68f, 0.68f, 0.68f});
    build.again("other trunk", build.mesh_of(trunk), other);
    build.again("other leaves", build.mesh_of(tree), other);

    const auto ball = [&](const char* name, const Material& material, const glm::vec3& at, float radius) {
        build.add(name, sphere(at + glm::vec3(0, radius + 0.004f, 0), radius, 20), build.material(material));
    };
    ball("chrome ball", metal("chrome", glm::vec3(0.92f)), {0.45f, 0, 1.15f}, 0.36f);
    ball("red ball", matte("red", {0.75f, 0.07f, 0.05f}), {-0.45f, 0, -1.3f}, 0.45f);
    ball("yellow ball", matte("yellow", {0.88f, 0.62f, 0.07f}), {-1.75f, 0, 0.95f}, 0.22f);
    build.camera({0.9f, 1.85f, 5.7f}, {0.05f, 0.62f, 0.0f}, 38);
    return build.take();
}

}  // namespace peelray
