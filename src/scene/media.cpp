#include "scene/media.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <unordered_map>

#include "scene/picture.h"

namespace peelray {
namespace {

/// Walls this near to each other, of the largest coordinate, may be one: rounding of transforms (shading_numbers.h has
/// the limit for rays, which is smaller).
constexpr float kTouching = 1e-5f;
/// Where the sum of the area vectors is a larger share of the area, a surface is not closed. A cup without a rim stays
/// below it, half a ball has 0.5.
constexpr double kOpenShare = 0.1;

/// What the triangles of a material in a mesh sum up to.
struct Extent {
    glm::dvec3 area_vector{0};  ///< 0 for a closed surface, wherever it is
    double area = 0;
    glm::dvec3 centre{0};  ///< times `area`
};

Extent extent_of(const Mesh& mesh, uint32_t material) {
    Extent sum;
    for (const Primitive& primitive : mesh.primitives) {
        if (primitive.material != material) continue;
        for (const glm::uvec3& t : primitive.triangles) {
            const glm::dvec3 a = primitive.positions[t.x], b = primitive.positions[t.y], c = primitive.positions[t.z];
            const glm::dvec3 area = glm::cross(b - a, c - a) / 2.0;
            sum.area_vector += area;
            sum.area += glm::length(area);
            sum.centre += (a + b + c) / 3.0 * glm::length(area);
        }
    }
    return sum;
}

/// By the divergence theorem; infinite for a surface that is not closed.
double volume_of(const Mesh& mesh, uint32_t material) {
    const Extent extent = extent_of(mesh, material);
    if (!(extent.area > 0) || glm::length(extent.area_vector) > kOpenShare * extent.area) return INFINITY;
    const glm::dvec3 centre = extent.centre / extent.area;
    double volume = 0;
    for (const Primitive& primitive : mesh.primitives) {
        if (primitive.material != material) continue;
        for (const glm::uvec3& t : primitive.triangles) {
            const glm::dvec3 a = primitive.positions[t.x], b = primitive.positions[t.y], c = primitive.positions[t.z];
            volume += glm::dot(a - centre, glm::cross(b - centre, c - centre)) / 6;
        }
    }
    return std::abs(volume);
}

/// Which vertices a surface connects; those at the same position are one.
class Connected {
  public:
    explicit Connected(const std::vector<glm::vec3>& positions) : parents_(positions.size()) {
        std::iota(parents_.begin(), parents_.end(), 0);
        struct Hash {
            size_t operator()(const glm::vec3& p) const {
                const std::hash<float> h;
                return h(p.x) * 73856093u ^ h(p.y) * 19349663u ^ h(p.z) * 83492791u;
            }
        };
        std::unordered_map<glm::vec3, uint32_t, Hash> first;
        for (uint32_t i = 0; i < positions.size(); i++) join(i, first.try_emplace(positions[i], i).first->second);
    }
    void join(uint32_t a, uint32_t b) {
        a = root(a);
        b = root(b);
        parents_[std::max(a, b)] = std::min(a, b);
    }
    uint32_t root(uint32_t i) {
        while (parents_[i] != i) i = parents_[i] = parents_[parents_[i]];
        return i;
    }

  private:
    std::vector<uint32_t> parents_;
};

struct PlacedBox {
    glm::vec3 lower, upper;
};

/// The boxes in the order of their lower x.
bool any_meet(std::vector<PlacedBox>& boxes) {
    std::sort(boxes.begin(), boxes.end(), [](const PlacedBox& a, const PlacedBox& b) { return a.lower.x < b.lower.x; });
    for (size_t i = 0; i < boxes.size(); i++)
        for (size_t j = i + 1; j < boxes.size() && boxes[j].lower.x <= boxes[i].upper.x; j++)
            if (boxes[j].lower.y <= boxes[i].upper.y && boxes[i].lower.y <= boxes[j].upper.y &&
                boxes[j].lower.z <= boxes[i].upper.z && boxes[i].lower.z <= boxes[j].upper.z)
                return true;
    return false;
}

/// Of all nodes: is it a body of a swarm?
std::vector<bool> swarming(const Scene& scene) {
    std::vector<bool> out(scene.nodes.size(), false);
    for (const Swarm& swarm : scene.generated.swarms)
        for (const int node : swarm.nodes) out[size_t(node)] = true;
    return out;
}

/// How often a primitive's surface goes around a point: its solid angle over 4π (van Oosterom and Strackee, "The Solid
/// Angle of a Plane Triangle", IEEE Transactions on Biomedical Engineering 30(2), 1983).
double winding(const Primitive& primitive, const glm::dvec3& point) {
    double angle = 0;
    for (const glm::uvec3& t : primitive.triangles) {
        const glm::dvec3 a = glm::dvec3(primitive.positions[t.x]) - point,
                         b = glm::dvec3(primitive.positions[t.y]) - point,
                         c = glm::dvec3(primitive.positions[t.z]) - point;
        const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
        angle += 2 * std::atan2(glm::dot(a, glm::cross(b, c)),
                                la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb);
    }
    return angle / (4 * 3.14159265358979323846);
}

}  // namespace

bool fills_volume(const Material& material) {
    return transmits(material) && material.thickness > 0 && !material.unlit;
}

MediaRanks media_ranks(const Scene& scene) {
    std::vector<double> volumes(scene.materials.size(), 0);
    const std::vector<glm::mat4> worlds = at_rest(scene).worlds;
    for (size_t n = 0; n < scene.nodes.size(); n++) {
        if (scene.nodes[n].mesh < 0) continue;
        const Mesh& mesh = scene.meshes[size_t(scene.nodes[n].mesh)];
        const double scale = std::abs(glm::determinant(glm::dmat3(worlds[n])));
        std::vector<uint32_t> seen;
        for (const Primitive& primitive : mesh.primitives) {
            const uint32_t material = primitive.material;
            if (!fills_volume(scene.materials[material]) || std::find(seen.begin(), seen.end(), material) != seen.end())
                continue;
            seen.push_back(material);
            volumes[material] = std::max(volumes[material], volume_of(mesh, material) * scale);
        }
    }
    MediaRanks ranks;
    ranks.of_material.assign(scene.materials.size(), MediaRanks::none);
    for (uint32_t i = 0; i < scene.materials.size(); i++)
        if (fills_volume(scene.materials[i])) ranks.materials.push_back(i);
    std::stable_sort(ranks.materials.begin(), ranks.materials.end(),
                     [&](uint32_t a, uint32_t b) { return volumes[a] < volumes[b]; });
    for (uint32_t i = 0; i < ranks.materials.size(); i++) ranks.of_material[ranks.materials[i]] = i;
    return ranks;
}

MediaPieces::MediaPieces(const Scene& scene) : pieces_(scene.meshes.size()) {
    for (size_t i = 0; i < scene.meshes.size(); i++)
        for (uint32_t p = 0; p < scene.meshes[i].primitives.size(); p++) {
            const Primitive& primitive = scene.meshes[i].primitives[p];
            if (!fills_volume(scene.materials[primitive.material])) continue;
            Connected connected(primitive.positions);
            for (const glm::uvec3& t : primitive.triangles) {
                connected.join(t.x, t.y);
                connected.join(t.x, t.z);
            }
            std::unordered_map<uint32_t, size_t> pieces;
            for (const glm::uvec3& t : primitive.triangles) {
                const auto [at, added] = pieces.try_emplace(connected.root(t.x), pieces_[i].size());
                if (added) pieces_[i].push_back({glm::vec3(INFINITY), glm::vec3(-INFINITY), p});
                Piece& piece = pieces_[i][at->second];
                for (int k = 0; k < 3; k++) {
                    piece.lower = glm::min(piece.lower, primitive.positions[t[k]]);
                    piece.upper = glm::max(piece.upper, primitive.positions[t[k]]);
                }
            }
        }
}

bool MediaPieces::may_overlap(const Scene& scene, const Moment& moment) const {
    std::vector<PlacedBox> boxes;
    const std::vector<bool> swarms = swarming(scene);
    for (size_t n = 0; n < scene.nodes.size(); n++) {
        if (scene.nodes[n].mesh < 0 || swarms[n]) continue;
        const glm::mat4& world = moment.worlds[n];
        for (const Piece& piece : pieces_[size_t(scene.nodes[n].mesh)]) {
            const glm::vec3 middle = (piece.lower + piece.upper) * 0.5f, half = (piece.upper - piece.lower) * 0.5f;
            const glm::vec3 centre = glm::vec3(world * glm::vec4(middle, 1));
            glm::vec3 reach(0);
            for (int k = 0; k < 3; k++) reach += glm::abs(glm::vec3(world[k])) * half[k];
            reach += kTouching * (glm::abs(centre) + reach);
            boxes.push_back({centre - reach, centre + reach});
        }
    }
    return any_meet(boxes);
}

std::vector<uint32_t> MediaPieces::around(const Scene& scene, const Moment& moment, const glm::dvec3& point) const {
    std::vector<uint32_t> media;
    const std::vector<bool> swarms = swarming(scene);
    for (size_t n = 0; n < scene.nodes.size(); n++) {
        if (scene.nodes[n].mesh < 0 || swarms[n]) continue;
        const auto mesh = size_t(scene.nodes[n].mesh);
        if (pieces_[mesh].empty() || glm::determinant(glm::dmat3(moment.worlds[n])) == 0) continue;
        const glm::dvec3 local = glm::dvec3(glm::inverse(glm::dmat4(moment.worlds[n])) * glm::dvec4(point, 1));
        // A cup may be two primitives of one material: what they go around together counts.
        std::map<uint32_t, double> windings;
        std::vector<bool> done(scene.meshes[mesh].primitives.size(), false);
        for (const Piece& piece : pieces_[mesh]) {
            const bool outside = glm::any(glm::lessThan(local, glm::dvec3(piece.lower))) ||
                                 glm::any(glm::greaterThan(local, glm::dvec3(piece.upper)));
            if (outside || done[piece.primitive]) continue;
            done[piece.primitive] = true;
            const Primitive& primitive = scene.meshes[mesh].primitives[piece.primitive];
            windings[primitive.material] += winding(primitive, local);
        }
        for (const auto& [material, times] : windings)
            media.insert(media.end(), size_t(std::clamp(std::ceil(times - 0.5 - 1e-6), 0.0, 15.0)), material);
    }
    return media;
}

}  // namespace peelray
