#include "scene/tangents.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <tuple>

#include "scene/normals.h"
#include "scene/transform.h"

namespace peelray {
namespace {

constexpr uint32_t kNone = UINT32_MAX;
/// Groups of more triangles are summed at once: telling apart which of them agree takes quadratic time.
constexpr size_t kLargestFan = 512;

/// A direction in the plane with this normal; 0: there is none.
glm::dvec3 in_plane(const glm::dvec3& v, const glm::dvec3& normal) {
    const glm::dvec3 flat = v - normal * glm::dot(normal, v);
    const double length = glm::length(flat);
    return length > std::numeric_limits<float>::min() ? flat / length : glm::dvec3(0);
}

class TangentMaker {
  public:
    TangentMaker(const Primitive& p, const std::vector<glm::vec2>& coordinates) : p_(p), uv_(coordinates) {
        join_vertices();
        measure_triangles();
        find_neighbours();
    }

    /// Per corner (3·triangle + k).
    std::vector<glm::vec4> corners() {
        tangents_.assign(3 * p_.triangles.size(), glm::vec4(0));
        group_of_.assign(tangents_.size(), kNone);
        uint32_t groups = 0;
        for (uint32_t corner = 0; corner < tangents_.size(); corner++) {
            const Triangle& triangle = triangles_[corner / 3];
            if (triangle.flat || triangle.any || group_of_[corner] != kNone) continue;
            finish_group(gather_group(corner, groups++, triangle.keeps_side));
        }
        copy_to_flat();
        return std::move(tangents_);
    }

  private:
    struct Triangle {
        glm::dvec3 along_u{0}, along_v{0};                        ///< unit
        std::array<uint32_t, 3> neighbours{kNone, kNone, kNone};  ///< across the edges 0-1, 1-2, 2-0
        bool keeps_side = false;                                  ///< its texture is not mirrored, as (u, v) runs
        bool any = true;    ///< its texture has no area: it joins what is around it
        bool flat = false;  ///< two corners coincide
    };

    uint32_t vertex(uint32_t corner) const { return joined_[p_.triangles[corner / 3][int(corner % 3)]]; }
    glm::dvec3 position(uint32_t corner) const { return p_.positions[p_.triangles[corner / 3][int(corner % 3)]]; }
    static uint32_t next(uint32_t corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; }
    static uint32_t before(uint32_t corner) { return corner % 3 == 0 ? corner + 2 : corner - 1; }

    /// Vertices that agree in position, normal and texture coordinates count as one.
    void join_vertices() {
        std::vector<uint32_t> order(p_.positions.size());
        std::iota(order.begin(), order.end(), 0u);
        const auto key = [&](uint32_t i) {
            const glm::vec3 &p = p_.positions[i], &n = p_.normals[i];
            return std::tuple(p.x, p.y, p.z, n.x, n.y, n.z, uv_[i].x, uv_[i].y);
        };
        std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
            const auto left = key(a), right = key(b);
            return left < right || (left == right && a < b);
        });
        joined_.resize(order.size());
        for (size_t i = 0; i < order.size(); i++) {
            const bool same = i > 0 && key(order[i]) == key(order[i - 1]);
            joined_[order[i]] = same ? joined_[order[i - 1]] : order[i];
        }
    }

    void measure_triangles() {
        triangles_.resize(p_.triangles.size());
        for (uint32_t i = 0; i < triangles_.size(); i++) {
            Triangle& t = triangles_[i];
            const glm::dvec3 a = position(3 * i), b = position(3 * i + 1), c = position(3 * i + 2);
            t.flat = a == b || b == c || c == a;
            const glm::uvec3 corners = p_.triangles[i];
            const glm::dvec2 first = uv_[corners.x], e = glm::dvec2(uv_[corners.y]) - first,
                             f = glm::dvec2(uv_[corners.z]) - first;
            const double area = e.x * f.y - e.y * f.x, side = area > 0 ? 1 : -1;
            t.keeps_side = area > 0;
            const glm::dvec3 u = side * (f.y * (b - a) - e.y * (c - a)), v = side * (e.x * (c - a) - f.x * (b - a));
            constexpr double least = std::numeric_limits<float>::min();
            const double length_u = glm::length(u), length_v = glm::length(v);
            t.any = !(std::abs(area) > least && length_u > least && length_v > least);
            if (t.any) continue;
            t.along_u = u / length_u;
            t.along_v = v / length_v;
        }
    }

    /// Triangles whose edges run the other way between the same two vertices; of several the first two.
    void find_neighbours() {
        struct Edge {
            uint32_t low, high, corner;
        };
        std::vector<Edge> edges;
        for (uint32_t corner = 0; corner < 3 * triangles_.size(); corner++) {
            if (triangles_[corner / 3].flat) continue;
            const uint32_t a = vertex(corner), b = vertex(next(corner));
            edges.push_back({std::min(a, b), std::max(a, b), corner});
        }
        std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
            return std::tie(a.low, a.high, a.corner) < std::tie(b.low, b.high, b.corner);
        });
        for (size_t i = 0; i < edges.size(); i++)
            for (size_t j = i + 1; j < edges.size() && edges[j].low == edges[i].low && edges[j].high == edges[i].high;
                 j++) {
                uint32_t &mine = neighbour(edges[i].corner), &other = neighbour(edges[j].corner);
                if (mine != kNone) break;
                if (other != kNone || vertex(edges[i].corner) == vertex(edges[j].corner)) continue;
                mine = edges[j].corner / 3;
                other = edges[i].corner / 3;
            }
    }
    /// Across the edge from this corner to the next.
    uint32_t& neighbour(uint32_t corner) { return triangles_[corner / 3].neighbours[corner % 3]; }

    /// All corners at this one's vertex that are connected with it by edges and have its side.
    std::vector<uint32_t> gather_group(uint32_t first, uint32_t group, bool keeps_side) {
        std::vector<uint32_t> members, open = {first / 3};
        const uint32_t shared = vertex(first);
        while (!open.empty()) {
            const uint32_t i = open.back();
            open.pop_back();
            uint32_t corner = 3 * i;
            while (corner < 3 * i + 3 && vertex(corner) != shared) corner++;
            if (corner == 3 * i + 3 || group_of_[corner] != kNone) continue;
            Triangle& triangle = triangles_[i];
            // The first group that meets a triangle without texture area decides which side it has.
            const bool is_new =
                group_of_[3 * i] == kNone && group_of_[3 * i + 1] == kNone && group_of_[3 * i + 2] == kNone;
            if (triangle.any && is_new) triangle.keeps_side = keeps_side;
            if (triangle.keeps_side != keeps_side) continue;
            group_of_[corner] = group;
            members.push_back(corner);
            for (const uint32_t beside : {neighbour(before(corner)), neighbour(corner)})
                if (beside != kNone) open.push_back(beside);
        }
        std::sort(members.begin(), members.end());
        return members;
    }

    /// A corner of a group as the tangent plane has it.
    struct Part {
        glm::dvec3 u{0}, v{0};  ///< unit; 0: it has no say
        double weight = 0;      ///< the corner's angle
    };

    Part part_of(uint32_t corner, const glm::dvec3& normal) const {
        const Triangle& triangle = triangles_[corner / 3];
        if (triangle.any) return {};
        const glm::dvec3 at = position(corner);
        const glm::dvec3 a = in_plane(position(before(corner)) - at, normal),
                         b = in_plane(position(next(corner)) - at, normal);
        return {in_plane(triangle.along_u, normal), in_plane(triangle.along_v, normal),
                std::acos(std::clamp(glm::dot(a, b), -1.0, 1.0))};
    }

    void finish_group(const std::vector<uint32_t>& members) {
        const glm::uvec3 own = p_.triangles[members[0] / 3];
        const glm::dvec3 normal = p_.normals[own[int(members[0] % 3)]];
        // The image's first row is where v is 0: its bitangent runs against v.
        const float side = triangles_[members[0] / 3].keeps_side ? -1.f : 1.f;
        std::vector<Part> parts;
        for (const uint32_t corner : members) parts.push_back(part_of(corner, normal));
        // Two whose textures run exactly against each other do not mix: impossible where all are near the first.
        const bool mixes =
            members.size() > kLargestFan || std::all_of(parts.begin(), parts.end(), [&](const Part& part) {
                return part.weight == 0 || (glm::dot(part.u, parts[0].u) > 0 && glm::dot(part.v, parts[0].v) > 0);
            });
        const auto agree = [](const Part& a, const Part& b) {
            constexpr double opposite = -1 + 1e-7;
            return glm::dot(a.u, b.u) > opposite && glm::dot(a.v, b.v) > opposite;
        };
        for (size_t i = 0; i < members.size(); i++) {
            if (mixes && i > 0) {
                tangents_[members[i]] = tangents_[members[0]];
                continue;
            }
            glm::dvec3 sum(0);
            for (const Part& part : parts)
                if (mixes || agree(parts[i], part)) sum += part.u * part.weight;
            const glm::vec3 tangent = unit_or(sum, glm::vec3(0));
            tangents_[members[i]] = glm::vec4(tangent, tangent == glm::vec3(0) ? 0.f : side);
        }
    }

    /// Corners of triangles without area, and others without a tangent, take that of another corner at their vertex.
    void copy_to_flat() {
        std::map<uint32_t, glm::vec4> known;
        const auto lacks = [&](uint32_t corner) { return tangents_[corner].w == 0; };
        for (uint32_t corner = 0; corner < tangents_.size(); corner++)
            if (lacks(corner)) known.try_emplace(vertex(corner), glm::vec4(0));
        if (known.empty()) return;
        for (uint32_t corner = 0; corner < tangents_.size(); corner++)
            if (const auto found = known.find(vertex(corner)); found != known.end() && found->second.w == 0)
                found->second = tangents_[corner];
        for (uint32_t corner = 0; corner < tangents_.size(); corner++)
            if (lacks(corner)) tangents_[corner] = known[vertex(corner)];
    }

    const Primitive& p_;
    const std::vector<glm::vec2>& uv_;
    std::vector<uint32_t> joined_;  ///< per vertex: the one that stands for all that agree with it
    std::vector<Triangle> triangles_;
    std::vector<uint32_t> group_of_;   ///< per corner
    std::vector<glm::vec4> tangents_;  ///< per corner
};

}  // namespace

void make_tangents(Primitive& p, const std::vector<glm::vec2>& coordinates) {
    const std::vector<glm::vec4> corners = TangentMaker(p, coordinates).corners();
    // A vertex keeps its first corner's tangent; copies of it take the others.
    std::vector<glm::vec4> tangents(p.positions.size(), glm::vec4(0));
    std::vector<bool> taken(p.positions.size(), false);
    std::vector<uint32_t> from(p.positions.size());
    std::iota(from.begin(), from.end(), 0u);
    std::multimap<uint32_t, uint32_t> copies;
    for (size_t i = 0; i < corners.size(); i++) {
        uint32_t& vertex = p.triangles[i / 3][int(i % 3)];
        if (!taken[vertex]) {
            taken[vertex] = true;
            tangents[vertex] = corners[i];
        }
        if (tangents[vertex] == corners[i]) continue;
        const auto [first, last] = copies.equal_range(vertex);
        auto copy = std::find_if(first, last, [&](const auto& entry) { return tangents[entry.second] == corners[i]; });
        if (copy == last) {
            copy = copies.emplace(vertex, uint32_t(from.size()));
            from.push_back(vertex);
            tangents.push_back(corners[i]);
        }
        vertex = copy->second;
    }
    if (from.size() > p.positions.size()) gather_vertices(p, from);
    p.tangents = std::move(tangents);
}

bool needs_tangents(const Material& material) {
    return material.normal_texture || material.coat_normal_texture || material.anisotropy > 0;
}

const MaterialTexture& tangent_texture(const Material& material) {
    if (material.normal_texture) return material.normal_texture;
    return material.coat_normal_texture ? material.coat_normal_texture : material.anisotropy_texture;
}

std::vector<glm::vec2> tangent_coordinates(const Material& material, const Primitive& p) {
    const MaterialTexture& texture = tangent_texture(material);
    std::vector<glm::vec2> coordinates;
    if (texture.uv_set <= p.more_uvs.size()) coordinates = texture.uv_set == 0 ? p.uvs : p.more_uvs[texture.uv_set - 1];
    for (glm::vec2& uv : coordinates) uv = texture.place(uv);
    return coordinates;
}

void complete_tangents(Scene& scene) {
    for (Mesh& mesh : scene.meshes)
        for (Primitive& p : mesh.primitives) {
            const Material& m = scene.materials[p.material];
            if (!needs_tangents(m) || !p.tangents.empty() || p.triangles.empty()) continue;
            std::vector<glm::vec2> coordinates = tangent_coordinates(m, p);
            coordinates.resize(p.positions.size(), glm::vec2(0));
            make_tangents(p, coordinates);
        }
}

}  // namespace peelray
