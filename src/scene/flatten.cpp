#include <algorithm>
#include <cmath>

#include "scene/deform.h"
#include "scene/moment.h"
#include "scene/normals.h"
#include "scene/transform.h"

namespace peelray {

namespace {

struct Totals {
    uint64_t vertices = 0, triangles = 0;
    bool colors = false, tangents = false;
    size_t more_uvs = 0;  ///< sets of texture coordinates beyond the first
};

Totals count(const Scene& scene) {
    Totals totals;
    for (const Node& node : scene.nodes) {
        if (node.mesh < 0) continue;
        for (const Primitive& primitive : scene.meshes[static_cast<size_t>(node.mesh)].primitives) {
            totals.vertices += primitive.positions.size();
            totals.triangles += primitive.triangles.size();
            totals.colors |= !primitive.colors.empty();
            totals.tangents |= !primitive.tangents.empty();
            totals.more_uvs = std::max(totals.more_uvs, primitive.more_uvs.size());
        }
    }
    return totals;
}

/// Texture coordinates and colours of a primitive whose positions were appended.
void append_attributes(Geometry& out, const Primitive& primitive, const Totals& totals) {
    if (primitive.uvs.empty())
        out.uvs.resize(out.positions.size(), glm::vec2(0));
    else
        out.uvs.insert(out.uvs.end(), primitive.uvs.begin(), primitive.uvs.end());
    append_uv_sets(out.more_uvs, primitive, out.positions.size());
    if (totals.colors && primitive.colors.empty())
        out.colors.resize(out.positions.size(), glm::vec4(1));
    else
        out.colors.insert(out.colors.end(), primitive.colors.begin(), primitive.colors.end());
}

void append_vertices(Geometry& out, const Deformed& vertices, const Node& node, const Totals& totals) {
    for (size_t i = 0; i < vertices.positions.size(); ++i) check_finite(vertices.positions[i], node, i);
    out.positions.insert(out.positions.end(), vertices.positions.begin(), vertices.positions.end());
    out.normals.insert(out.normals.end(), vertices.normals.begin(), vertices.normals.end());
    out.tangents.insert(out.tangents.end(), vertices.tangents.begin(), vertices.tangents.end());
    if (totals.tangents) out.tangents.resize(out.positions.size(), glm::vec4(0));
}

void append_triangles(Geometry& out, const Primitive& primitive, uint32_t first, bool mirrors) {
    for (glm::uvec3 t : primitive.triangles) {
        if (mirrors) std::swap(t.y, t.z);
        t += first;
        const glm::dvec3 a = out.positions[t.x], b = out.positions[t.y], c = out.positions[t.z];
        if (glm::length(glm::cross(b - a, c - a)) == 0) ++out.zero_area;
        for (int k = 0; k < 3; ++k) {
            out.lower = glm::min(out.lower, out.positions[t[k]]);
            out.upper = glm::max(out.upper, out.positions[t[k]]);
        }
        out.triangles.push_back(t);
    }
    out.materials.resize(out.triangles.size(), primitive.material);
}

}  // namespace

Geometry flatten(const Scene& scene) {
    return flatten(scene, at_rest(scene));
}

Geometry flatten(const Scene& scene, const Moment& moment) {
    const Totals totals = count(scene);
    check_size(scene, totals.vertices, totals.triangles);
    Geometry out;
    out.positions.reserve(totals.vertices);
    out.normals.reserve(totals.vertices);
    out.uvs.reserve(totals.vertices);
    out.more_uvs.resize(totals.more_uvs);
    if (totals.colors) out.colors.reserve(totals.vertices);
    out.triangles.reserve(totals.triangles);
    out.materials.reserve(totals.triangles);
    out.lower = glm::vec3(INFINITY);
    out.upper = glm::vec3(-INFINITY);
    for (size_t n = 0; n < scene.nodes.size(); ++n) {
        const Node& node = scene.nodes[n];
        if (node.mesh < 0) continue;
        const Mesh& mesh = scene.meshes[static_cast<size_t>(node.mesh)];
        const auto first_triangle = static_cast<uint32_t>(out.triangles.size());
        for (const Primitive& primitive : mesh.primitives) {
            const auto first = static_cast<uint32_t>(out.positions.size());
            const Deformed vertices = placed(scene, moment, n, primitive);
            append_vertices(out, vertices, node, totals);
            append_attributes(out, primitive, totals);
            append_triangles(out, primitive, first, vertices.mirrors);
        }
        const auto count = static_cast<uint32_t>(out.triangles.size()) - first_triangle;
        if (count > 0) out.objects.push_back({first_triangle, count});
    }
    return out;
}

}  // namespace peelray
