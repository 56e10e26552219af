// A tree of real geometry: branches are tapered tubes that fork again and again, the last ones carry leaves.

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>
#include <vector>

#include "builtin/shapes.h"

namespace peelray {

namespace {

constexpr int generations = 7;  // trunk, then six forks
constexpr int leaves_per_twig = 26;

struct Branch {
    glm::vec3 base, direction;
    float length, radius;
    int generation;
};

/// A leaf: a diamond of two triangles, folded a little along its rib, so that light falls differently on its halves.
void add_leaf(Primitive& out, const glm::vec3& stem, const glm::vec3& along, float length, Random& random) {
    const glm::vec3 side =
        glm::normalize(glm::cross(along, glm::vec3(random.between(-0.6f, 0.6f), 1, random.between(-0.6f, 0.6f))));
    const glm::vec3 up = glm::cross(side, along);
    const glm::vec3 middle = stem + along * (0.45f * length), tip = stem + along * length;
    const float width = 0.28f * length, fold = 0.09f * length;
    for (const float sign : {-1.f, 1.f}) {
        const glm::vec3 edge = middle + side * (sign * width) + up * fold;
        const glm::vec3 a = sign > 0 ? edge : tip, b = sign > 0 ? tip : edge;
        const auto first = static_cast<uint32_t>(out.positions.size());
        out.positions.insert(out.positions.end(), {stem, a, b});
        out.normals.insert(out.normals.end(), 3, glm::normalize(glm::cross(a - stem, b - stem)));
        out.triangles.push_back({first, first + 1, first + 2});
    }
}

void add_twig_leaves(Primitive& leaves, const Branch& twig, Random& random) {
    const glm::vec3 x = any_perpendicular(twig.direction), y = glm::cross(twig.direction, x);
    for (int i = 0; i < leaves_per_twig; ++i) {
        const float angle = 2.399963f * static_cast<float>(i) + random.between(-0.4f, 0.4f);  // the golden angle
        const glm::vec3 outwards = std::cos(angle) * x + std::sin(angle) * y;
        const glm::vec3 along = glm::normalize(outwards + twig.direction * random.between(0.2f, 0.9f) +
                                               glm::vec3(0, random.between(-0.5f, 0.2f), 0));
        const glm::vec3 stem = twig.base + twig.direction * (twig.length * random.between(0.15f, 1.05f));
        add_leaf(leaves, stem, along, random.between(0.13f, 0.22f), random);
    }
}

void fork(const Branch& parent, Random& random, std::vector<Branch>& out) {
    const glm::vec3 tip = parent.base + parent.direction * parent.length;
    const glm::vec3 x = any_perpendicular(parent.direction), y = glm::cross(parent.direction, x);
    const int children = parent.generation < 2 ? 4 : 3;
    const float phase = random.between(0, 6.28f);
    for (int i = 0; i < children; ++i) {
        const float angle =
            phase + 6.2831853f * (static_cast<float>(i) + random.between(-0.2f, 0.2f)) / static_cast<float>(children);
        const float spread = random.between(0.4f, 1.0f);
        glm::vec3 direction = parent.direction + spread * (std::cos(angle) * x + std::sin(angle) * y);
        direction.y += 0.02f;  // towards the light
        // Children start at different heights of the upper part of their parent, as on a real tree.
        const glm::vec3 base = tip - parent.direction * (parent.length * random.between(0.0f, 0.4f));
        out.push_back({base, glm::normalize(direction), parent.length * random.between(0.66f, 0.82f),
                       parent.radius * random.between(0.52f, 0.66f), parent.generation + 1});
    }
}

}  // namespace

Scene make_tree() {
    SceneBuilder build("builtin:tree");
    Random random(7);
    Primitive wood, leaves;
    std::vector<Branch> todo{{{0, -0.02f, 0}, glm::normalize(glm::vec3(0.04f, 1, 0.02f)), 1.35f, 0.17f, 1}};
    while (!todo.empty()) {
        const Branch branch = todo.back();
        todo.pop_back();
        const glm::vec3 tip = branch.base + branch.direction * branch.length;
        add_tube(wood, branch.base, tip, branch.radius, branch.radius * 0.68f,
                 branch.generation < 3   ? 12u
                 : branch.generation < 5 ? 8u
                                         : 5u);
        if (branch.generation == generations)
            add_twig_leaves(leaves, branch, random);
        else
            fork(branch, random, todo);
    }
    build.add("ground", parallelogram({-7, 0, 7}, {14, 0, 0}, {0, 0, -14}),
              build.material(matte("ground", {0.42f, 0.38f, 0.28f})));
    build.add("wood", std::move(wood), build.material(matte("bark", {0.16f, 0.10f, 0.06f})));
    Material leaf = matte("leaves", {0.12f, 0.33f, 0.06f});
    leaf.roughness = 0.6f;
    build.add("leaves", std::move(leaves), build.material(leaf));
    build.camera({3.4f, 2.6f, 8.6f}, {0, 1.85f, 0}, 36);
    return build.take();
}

}  // namespace peelray
