#include "scene/deform.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "scene/transform.h"

namespace peelray {
namespace {

/// The primitive in its own space with its morph targets mixed in.
void morph(const Primitive& primitive, std::span<const float> weights, Deformed& out) {
    out.positions = primitive.positions;
    out.normals = primitive.normals;
    out.tangents = primitive.tangents;
    for (size_t k = 0; k < std::min(primitive.targets.size(), weights.size()); k++) {
        const MorphTarget& target = primitive.targets[k];
        if (weights[k] == 0) continue;
        for (size_t i = 0; i < target.positions.size(); i++) out.positions[i] += weights[k] * target.positions[i];
        for (size_t i = 0; i < target.normals.size(); i++) out.normals[i] += weights[k] * target.normals[i];
        for (size_t i = 0; i < std::min(target.tangents.size(), out.tangents.size()); i++)
            out.tangents[i] += glm::vec4(weights[k] * target.tangents[i], 0);
    }
}

glm::mat4 blended(const JointWeights& vertex, const std::vector<glm::mat4>& joints, const glm::mat4& otherwise) {
    glm::mat4 sum(0);
    float weight = 0;
    for (size_t k = 0; k < vertex.weights.size(); k++) {
        if (vertex.weights[k] == 0) continue;
        sum += vertex.weights[k] * joints[vertex.joints[k]];
        weight += vertex.weights[k];
    }
    return weight > 0 ? sum : otherwise;
}

/// A tangent lies in the surface and goes with it; the bitangent's side changes where the transform mirrors.
glm::vec4 moved_tangent(const glm::vec4& tangent, const glm::mat4& matrix, bool mirrors) {
    const glm::vec3 moved = unit_or(glm::mat3(matrix) * glm::vec3(tangent), glm::vec3(0));
    return glm::vec4(moved, moved == glm::vec3(0) ? 0 : mirrors ? -tangent.w : tangent.w);
}

}  // namespace

std::vector<glm::mat4> joint_matrices(const Scene& scene, const Node& node, std::span<const glm::mat4> worlds,
                                      const glm::mat4& world) {
    const Skin& skin = scene.skins[size_t(node.skin)];
    glm::mat4 from_parent(1);
    if (node.is_instance) {
        // Where the parent's space is flat there is no way back into it: the skin stays where its joints are.
        const glm::mat4& parent = worlds[size_t(node.parent)];
        if (glm::determinant(parent) != 0) from_parent = world * glm::inverse(parent);
    }
    std::vector<glm::mat4> out;
    for (size_t i = 0; i < skin.joints.size(); i++)
        out.push_back(from_parent * worlds[size_t(skin.joints[i])] * skin.inverse_bind[i]);
    return out;
}

Deformed deform(const Scene& scene, const Node& node, const Primitive& primitive, std::span<const float> weights,
                std::span<const glm::mat4> worlds, const glm::mat4& world) {
    Deformed out;
    morph(primitive, weights, out);
    const bool skinned = node.skin >= 0 && !primitive.joints.empty();
    std::vector<glm::mat4> joints;
    if (skinned) joints = joint_matrices(scene, node, worlds, world);
    glm::mat4 matrix = world;
    NormalTransform to_normal(world);
    for (size_t i = 0; i < out.positions.size(); i++) {
        if (skinned) {
            matrix = blended(primitive.joints[i], joints, world);
            to_normal = NormalTransform(matrix);
        }
        if (i == 0) out.mirrors = to_normal.mirrors;
        out.positions[i] = glm::vec3(matrix * glm::vec4(out.positions[i], 1));
        out.normals[i] = to_normal(out.normals[i], primitive.normals[i]);
        if (!out.tangents.empty()) out.tangents[i] = moved_tangent(out.tangents[i], matrix, to_normal.mirrors);
    }
    if (primitive.flat)
        for (const glm::uvec3& t : primitive.triangles) {
            const glm::dvec3 a = out.positions[t.x], b = out.positions[t.y], c = out.positions[t.z];
            const glm::vec3 normal = unit_or((out.mirrors ? -1.0 : 1.0) * glm::cross(b - a, c - a), out.normals[t.x]);
            out.normals[t.x] = out.normals[t.y] = out.normals[t.z] = normal;
        }
    return out;
}

Deformed transformed(const Primitive& primitive, const glm::mat4& matrix) {
    const NormalTransform to_normal(matrix);
    Deformed out;
    out.mirrors = to_normal.mirrors;
    out.positions.reserve(primitive.positions.size());
    out.normals.reserve(primitive.normals.size());
    for (const glm::vec3& p : primitive.positions) out.positions.push_back(glm::vec3(matrix * glm::vec4(p, 1)));
    for (const glm::vec3& normal : primitive.normals)
        out.normals.push_back(to_normal(normal, unit_or(normal, glm::vec3(0, 1, 0))));
    out.tangents.reserve(primitive.tangents.size());
    for (const glm::vec4& tangent : primitive.tangents)
        out.tangents.push_back(moved_tangent(tangent, matrix, to_normal.mirrors));
    return out;
}

Primitive with_surface(const Primitive& primitive, const Moment::Surface& surface) {
    Primitive moved = primitive;
    moved.positions = surface.positions;
    moved.normals = surface.normals;
    return moved;
}

Deformed placed(const Scene& scene, const Moment& moment, size_t node, const Primitive& primitive) {
    const glm::mat4& world = moment.worlds[node];
    if (const Moment::Surface* surface = moment.surface_of(int(node)))
        return transformed(with_surface(primitive, *surface), world);
    if (is_rigid(primitive, scene.nodes[node])) return transformed(primitive, world);
    return deform(scene, scene.nodes[node], primitive, weights_of(scene, moment, node), moment.worlds, world);
}

void check_finite(const glm::vec3& p, const Node& node, size_t vertex) {
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
        fail("node \"{}\": vertex {} leaves the range of 32-bit floats when transformed; scale the scene down",
             node.name, vertex);
}

void check_size(const Scene& scene, uint64_t vertices, uint64_t triangles) {
    if (triangles == 0) fail("{}: the scene has no triangles; give a file with a surface", scene.name);
    constexpr uint64_t limit = uint64_t(1) << 29;
    if (vertices > limit || triangles > limit)
        fail("{}: {} vertices and {} triangles with all instances, at most {} of each are supported; split the scene",
             scene.name, vertices, triangles, limit);
}

}  // namespace peelray
