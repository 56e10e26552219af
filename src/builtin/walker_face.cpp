#include "builtin/walker_face.h"

#include <cmath>
#include <numbers>

#include "builtin/shapes.h"
#include "scene/transform.h"

namespace peelray {

namespace {

using glm::vec3;

void append(Primitive& to, const Primitive& from) {
    const auto first = uint32_t(to.positions.size());
    to.positions.insert(to.positions.end(), from.positions.begin(), from.positions.end());
    to.normals.insert(to.normals.end(), from.normals.begin(), from.normals.end());
    for (const glm::uvec3& t : from.triangles) to.triangles.push_back(t + first);
}

/// A flat bead on the head.
Primitive bead(const Field& head, const vec3& near, const vec3& radii) {
    const vec3 at = onto_surface(head, near), out = unit_or(gradient(head, at), vec3(0, 0, 1));
    const vec3 side = glm::normalize(glm::cross(vec3(0, 1, 0), out)), up = glm::cross(out, side);
    Primitive shape = sphere(vec3(0), 1, 7);
    for (size_t i = 0; i < shape.positions.size(); ++i) {
        const vec3 p = shape.positions[i] * radii, n = glm::normalize(shape.normals[i] / radii);
        shape.positions[i] = at + p.x * side + p.y * up + p.z * out;
        shape.normals[i] = n.x * side + n.y * up + n.z * out;
    }
    return shape;
}

/// A line drawn on the head, from x = -`half` to `half` around `middle`, that rises by `rise` towards both ends; its
/// ends are pointed.
Primitive stroke(const Field& head, const vec3& middle, float half, float rise, float slant, float thickness) {
    constexpr uint32_t sides = 8, rings = 13;
    std::vector<vec3> line;
    for (uint32_t i = 0; i <= rings + 1; ++i) {
        const float x = 2 * float(i) / float(rings + 1) - 1;
        line.push_back(onto_surface(head, middle + vec3(half * x, rise * x * x + slant * x, 0)));
    }
    Primitive shape;
    const auto add = [&](const vec3& p, const vec3& normal) {
        shape.positions.push_back(p);
        shape.normals.push_back(normal);
    };
    add(line.front(), glm::normalize(line[0] - line[1]));
    for (uint32_t i = 1; i <= rings; ++i) {
        const vec3 along = glm::normalize(line[i + 1] - line[i - 1]);
        const vec3 out = unit_or(gradient(head, line[i]), vec3(0, 0, 1)),
                   across = glm::normalize(glm::cross(along, out));
        const vec3 above = glm::cross(across, along);
        const float x = 2 * float(i) / float(rings + 1) - 1, radius = thickness * std::sqrt(1 - x * x);
        for (uint32_t k = 0; k < sides; ++k) {
            const float angle = 2 * std::numbers::pi_v<float> * float(k) / float(sides);
            const vec3 normal = std::cos(angle) * above + std::sin(angle) * across;
            add(line[i] + radius * normal, normal);
        }
    }
    add(line.back(), glm::normalize(line[rings + 1] - line[rings]));
    const auto vertex = [&](uint32_t ring, uint32_t k) { return 1 + (ring - 1) * sides + k % sides; };
    const auto last = uint32_t(shape.positions.size() - 1);
    for (uint32_t k = 0; k < sides; ++k) {
        shape.triangles.push_back({0, vertex(1, k + 1), vertex(1, k)});
        for (uint32_t i = 1; i < rings; ++i) {
            shape.triangles.push_back({vertex(i, k), vertex(i, k + 1), vertex(i + 1, k + 1)});
            shape.triangles.push_back({vertex(i, k), vertex(i + 1, k + 1), vertex(i + 1, k)});
        }
        shape.triangles.push_back({last, vertex(rings, k), vertex(rings, k + 1)});
    }
    return shape;
}

}  // namespace

WalkerFace walker_face(const Field& head) {
    WalkerFace face;
    for (const float side : {-1.f, 1.f}) {
        append(face.eyes, bead(head, {0.056f * side, 1.408f, 0.145f}, {0.0165f, 0.021f, 0.009f}));
        append(face.lines, stroke(head, {0.058f * side, 1.457f, 0.135f}, 0.024f, -0.006f, 0.003f * side, 0.0062f));
    }
    append(face.lines, stroke(head, {0, 1.322f, 0.14f}, 0.040f, 0.014f, 0, 0.0055f));
    return face;
}

}  // namespace peelray
