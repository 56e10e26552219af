#include "assembly/assembly.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "assembly/grouping.h"
#include "base/error.h"
#include "scene/deform.h"
#include "scene/normals.h"
#include "scene/transform.h"

namespace peelray {
namespace {

/// From this many triangles on, a mesh that several nodes show is worth a cube of its own; smaller ones are copied.
constexpr uint64_t kSharedMesh = 500, kSharedTriangles = 20'000;
/// Rays are transformed into an instance's space in single precision: a transform that squeezes a cube to less than
/// this share of the cube of its longest edge would leave too little precision.
constexpr double kLeastVolume = 1e-3;

/// A primitive of a node.
struct Place {
    int node;
    uint32_t primitive;
};

/// Can rays be transformed there and back?
bool is_invertible(const glm::mat4& m) {
    const glm::dvec3 x(m[0]), y(m[1]), z(m[2]);
    const double longest = std::max({glm::length(x), glm::length(y), glm::length(z)});
    return longest > 1e-18 && longest < 1e18 &&
           std::abs(glm::dot(x, glm::cross(y, z))) >= kLeastVolume * std::pow(longest, 3);
}

Part part_of(const Primitive& primitive, const Deformed& vertices) {
    Part part{glm::vec3(INFINITY), glm::vec3(-INFINITY), primitive.triangles.size(), 0};
    for (const glm::uvec3& t : primitive.triangles) {
        const glm::vec3 &a = vertices.positions[t.x], &b = vertices.positions[t.y], &c = vertices.positions[t.z];
        part.lower = glm::min(part.lower, glm::min(a, glm::min(b, c)));
        part.upper = glm::max(part.upper, glm::max(a, glm::max(b, c)));
        part.area += 0.5 * glm::length(glm::cross(glm::dvec3(b) - glm::dvec3(a), glm::dvec3(c) - glm::dvec3(a)));
    }
    return part;
}

class Assembler {
  public:
    Assembler(const Scene& scene, const Moment& moment, const Motion& motion)
        : scene_(scene), moment_(moment), motion_(motion), worlds_(moment.worlds), still_(scene.nodes.size()) {
        find_generated();
        find_anchors();
        number_triangles();
    }

    Assembly take() {
        sort_places();
        find_shared();
        for (auto& [anchor, places] : fixed_) add_fixed(anchor, places);
        for (auto& [mesh, nodes] : shared_) add_shared(mesh, nodes);
        out_.fixed = uint32_t(out_.bodies.size());
        for (auto& [key, places] : deforming_) add_deforming(places);
        std::stable_sort(out_.instances.begin(), out_.instances.end(),
                         [](const auto& a, const auto& b) { return a.body < b.body; });
        for (Instance& instance : out_.instances)
            instance.moves =
                instance.node >= 0 && (motion_.moves[size_t(instance.node)] || generated_.contains(instance.node));
        return std::move(out_);
    }

  private:
    using Instance = Assembly::Instance;

    const Mesh& mesh_of(int node) const { return scene_.meshes[size_t(scene_.nodes[size_t(node)].mesh)]; }
    const Primitive& primitive_of(const Place& place) const { return mesh_of(place.node).primitives[place.primitive]; }

    /// What moves by passes of its own.
    void find_generated() {
        out_.generates = motion_.generates;
        if (!motion_.generates) return;
        for (const Swarm& swarm : scene_.generated.swarms) generated_.insert(swarm.nodes.begin(), swarm.nodes.end());
        for (const Water& water : scene_.generated.waters) {
            surfaces_.push_back(water.node);
            for (const Water::Float& f : water.floats) generated_.insert(f.node);
        }
        for (const Cloth& cloth : scene_.generated.cloths) surfaces_.push_back(cloth.node);
        out_.surfaces.resize(surfaces_.size());
    }

    /// The nearest node above each one, itself included, that an animation moves, and how the node stands in it.
    void find_anchors() {
        for (size_t i = 0; i < scene_.nodes.size(); i++) {
            const Node& node = scene_.nodes[i];
            const glm::mat4 local(moment_.locals[i]);
            const auto parent = size_t(node.parent);
            still_[i] = node.parent < 0
                            ? Still{-1, false, local}
                            : Still{still_[parent].anchor, still_[parent].scaled, still_[parent].offset * local};
            // Far from the origin a detour over another node's space would add two large numbers.
            const bool is_own = motion_.moves[i] || (scene_.precise && still_[i].anchor >= 0 && node.mesh >= 0);
            if (is_own) still_[i] = {int(i), still_[i].scaled || motion_.scales[i], glm::mat4(1)};
            // What stands in the world needs no detour.
            if (still_[i].anchor < 0) still_[i].offset = worlds_[i];
        }
    }

    /// File order: the first triangle of each primitive, and the object of each node.
    void number_triangles() {
        uint64_t vertices = 0;
        uint32_t objects = 0;
        first_ids_.resize(scene_.nodes.size());
        objects_.resize(scene_.nodes.size());
        for (size_t n = 0; n < scene_.nodes.size(); n++) {
            if (scene_.nodes[n].mesh < 0) continue;
            const uint64_t before = out_.shown;
            for (const Primitive& primitive : mesh_of(int(n)).primitives) {
                first_ids_[n].push_back(uint32_t(out_.shown));
                out_.shown += primitive.triangles.size();
                vertices += primitive.positions.size();
                has_colors_ |= !primitive.colors.empty();
                has_tangents_ |= !primitive.tangents.empty();
                if (primitive.more_uvs.size() > out_.more_uvs.size()) out_.more_uvs.resize(primitive.more_uvs.size());
            }
            objects_[n] = objects;
            objects += out_.shown > before;
        }
        check_size(scene_, vertices, out_.shown);
    }

    bool is_surface(int node) const { return std::find(surfaces_.begin(), surfaces_.end(), node) != surfaces_.end(); }

    bool deforms(const Place& place) const {
        const Node& node = scene_.nodes[size_t(place.node)];
        const Primitive& primitive = primitive_of(place);
        if (generated_.contains(place.node)) return false;
        if (is_surface(place.node)) return true;
        if (!primitive.targets.empty() && motion_.morphs[size_t(place.node)]) return true;
        if (!primitive.joints.empty() && node.skin >= 0) {
            const std::vector<int>& joints = scene_.skins[size_t(node.skin)].joints;
            const auto moves = [&](int joint) { return still_[size_t(joint)].anchor >= 0; };
            return std::any_of(joints.begin(), joints.end(), moves) ||
                   (moves(place.node) && (node.is_instance || has_free_vertex(primitive)));
        }
        // A changing scale is not a rigid motion, and it may leave no space to transform rays into.
        const Still& still = still_[size_t(place.node)];
        return still.anchor >= 0 &&
               (still.scaled || !is_invertible(worlds_[size_t(still.anchor)]) || !is_invertible(still.offset));
    }

    /// A vertex that no joint pulls at follows its node.
    static bool has_free_vertex(const Primitive& primitive) {
        return std::any_of(primitive.joints.begin(), primitive.joints.end(), [](const JointWeights& vertex) {
            return std::all_of(vertex.weights.begin(), vertex.weights.end(), [](float w) { return w == 0; });
        });
    }

    void sort_places() {
        for (int n = 0; n < int(scene_.nodes.size()); n++) {
            const Node& node = scene_.nodes[size_t(n)];
            if (node.mesh < 0) continue;
            for (uint32_t p = 0; p < mesh_of(n).primitives.size(); p++) {
                const Place place{n, p};
                if (primitive_of(place).triangles.empty()) continue;
                const bool skinned = node.skin >= 0 && !primitive_of(place).joints.empty();
                if (!deforms(place))
                    // A skin that stands still stands in the world, wherever its node goes.
                    fixed_[skinned ? -1 : still_[size_t(n)].anchor].push_back(place);
                else if (skinned)
                    deforming_[{0, node.skin}].push_back(place);
                else if (still_[size_t(n)].anchor >= 0 && primitive_of(place).targets.empty())
                    deforming_[{1, still_[size_t(n)].anchor}].push_back(place);
                else
                    deforming_[{2, n}].push_back(place);
            }
        }
    }

    /// Can all of the node's mesh be shown by an instance?
    bool may_share(int n) const {
        const Node& node = scene_.nodes[size_t(n)];
        for (uint32_t p = 0; p < mesh_of(n).primitives.size(); p++)
            if (!is_rigid(primitive_of({n, p}), node) || deforms({n, p})) return false;
        return is_invertible(still_[size_t(n)].offset);
    }

    /// Meshes of several nodes that are worth a cube of their own; their places leave fixed_.
    void find_shared() {
        std::map<int, std::vector<int>> users;
        for (int n = 0; n < int(scene_.nodes.size()); n++)
            if (scene_.nodes[size_t(n)].mesh >= 0 && may_share(n)) users[scene_.nodes[size_t(n)].mesh].push_back(n);
        std::set<int> taken;
        for (auto& [mesh, nodes] : users) {
            uint64_t triangles = 0, parts = 0;
            for (const Primitive& primitive : scene_.meshes[size_t(mesh)].primitives) {
                triangles += primitive.triangles.size();
                parts += !primitive.triangles.empty();
            }
            if (nodes.size() < 2 || triangles == 0) continue;
            // What moves by itself is an instance anyway.
            const bool alone = std::all_of(nodes.begin(), nodes.end(), [&](int n) {
                const int anchor = still_[size_t(n)].anchor;
                return anchor >= 0 && fixed_[anchor].size() == parts;
            });
            if (!alone && triangles < kSharedMesh && triangles * nodes.size() < kSharedTriangles) continue;
            taken.insert(nodes.begin(), nodes.end());
            shared_[mesh] = std::move(nodes);
        }
        for (auto& [anchor, places] : fixed_)
            std::erase_if(places, [&](const Place& place) { return taken.contains(place.node); });
    }

    // --- Bodies ---

    void begin_body() {
        out_.bodies.push_back({uint32_t(out_.triangles.size()), 0, uint32_t(out_.positions.size()), 0,
                               glm::vec3(INFINITY), glm::vec3(-INFINITY)});
    }

    void append(const Place& place, const Deformed& vertices, uint32_t first_id, uint32_t object) {
        append(place, vertices, part_of(primitive_of(place), vertices), first_id, object);
    }
    void append(const Place& place, const Deformed& vertices, const Part& part, uint32_t first_id, uint32_t object) {
        const Primitive& primitive = primitive_of(place);
        Assembly::Body& body = out_.bodies.back();
        const auto first = uint32_t(out_.positions.size()), count = uint32_t(vertices.positions.size());
        for (size_t i = 0; i < vertices.positions.size(); i++)
            check_finite(vertices.positions[i], scene_.nodes[size_t(place.node)], i);
        out_.positions.insert(out_.positions.end(), vertices.positions.begin(), vertices.positions.end());
        out_.normals.insert(out_.normals.end(), vertices.normals.begin(), vertices.normals.end());
        out_.uvs.insert(out_.uvs.end(), primitive.uvs.begin(), primitive.uvs.end());
        out_.uvs.resize(out_.positions.size(), glm::vec2(0));
        append_uv_sets(out_.more_uvs, primitive, out_.positions.size());
        out_.tangents.insert(out_.tangents.end(), vertices.tangents.begin(), vertices.tangents.end());
        if (has_tangents_) out_.tangents.resize(out_.positions.size(), glm::vec4(0));
        if (has_colors_) {
            out_.colors.insert(out_.colors.end(), primitive.colors.begin(), primitive.colors.end());
            out_.colors.resize(out_.positions.size(), glm::vec4(1));
        }
        body.lower = glm::min(body.lower, part.lower);
        body.upper = glm::max(body.upper, part.upper);
        body.inverse_edges += double(part.triangles) / mean_edge(part.triangles, part.area);
        for (size_t i = 0; i < primitive.triangles.size(); i++) {
            glm::uvec3 t = primitive.triangles[i];
            if (vertices.mirrors) std::swap(t.y, t.z);
            out_.triangles.push_back(t + first);
            out_.ids.push_back(first_id + uint32_t(i));
        }
        out_.materials.resize(out_.triangles.size(), primitive.material);
        out_.objects.resize(out_.triangles.size(), object);
        body.vertices += count;
        body.triangles = uint32_t(out_.triangles.size()) - body.first_triangle;
    }

    /// A primitive that does not change its shape, in its anchor's space.
    Deformed fixed_vertices(const Place& place) const {
        const Node& node = scene_.nodes[size_t(place.node)];
        const Primitive& primitive = primitive_of(place);
        const bool skinned = node.skin >= 0 && !primitive.joints.empty();
        // A skin's joints speak of the world; nothing of it moves.
        const glm::mat4& matrix = skinned ? worlds_[size_t(place.node)] : still_[size_t(place.node)].offset;
        if (is_rigid(primitive, node) && !moment_.surface_of(place.node)) return transformed(primitive, matrix);
        return deformed(place, matrix);
    }

    Deformed deformed(const Place& place, const glm::mat4& matrix) const {
        const auto node = size_t(place.node);
        if (const Moment::Surface* surface = moment_.surface_of(place.node))
            return transformed(with_surface(primitive_of(place), *surface), matrix);
        return deform(scene_, scene_.nodes[node], primitive_of(place), weights_of(scene_, moment_, node), worlds_,
                      matrix);
    }

    uint32_t first_id(const Place& place) const { return first_ids_[size_t(place.node)][place.primitive]; }

    void add_fixed(int anchor, const std::vector<Place>& places) {
        std::vector<Deformed> vertices;
        std::vector<Part> parts;
        for (const Place& place : places) {
            vertices.push_back(fixed_vertices(place));
            parts.push_back(part_of(primitive_of(place), vertices.back()));
        }
        for (const std::vector<uint32_t>& group : group_parts(parts)) {
            begin_body();
            for (uint32_t i : group)
                append(places[i], vertices[i], parts[i], first_id(places[i]), objects_[size_t(places[i].node)]);
            out_.instances.push_back({uint32_t(out_.bodies.size() - 1), anchor, glm::mat4(1), 0, 0});
        }
    }

    void add_shared(int mesh, const std::vector<int>& nodes) {
        begin_body();
        const std::vector<uint32_t>& ids = first_ids_[size_t(nodes[0])];
        for (uint32_t p = 0; p < scene_.meshes[size_t(mesh)].primitives.size(); p++)
            append({nodes[0], p}, transformed(primitive_of({nodes[0], p}), glm::mat4(1)), ids[p] - ids[0], 0);
        for (int n : nodes)
            out_.instances.push_back({uint32_t(out_.bodies.size() - 1), still_[size_t(n)].anchor,
                                      still_[size_t(n)].offset, first_ids_[size_t(n)][0], objects_[size_t(n)]});
    }

    void add_deforming(const std::vector<Place>& places) {
        begin_body();
        const auto body = uint32_t(out_.bodies.size() - 1);
        for (const Place& place : places) {
            const Deformed vertices = deformed(place, worlds_[size_t(place.node)]);
            const Assembly::Piece piece{place.node,
                                        place.primitive,
                                        body,
                                        uint32_t(out_.positions.size()),
                                        uint32_t(out_.triangles.size()),
                                        vertices.mirrors};
            if (is_surface(place.node))
                out_.surfaces[size_t(std::find(surfaces_.begin(), surfaces_.end(), place.node) - surfaces_.begin())] =
                    piece;
            else
                out_.pieces.push_back(piece);
            append(place, vertices, first_id(place), objects_[size_t(place.node)]);
        }
        out_.instances.push_back({body, -1, glm::mat4(1), 0, 0});
    }

    struct Still {
        int anchor = -1;
        bool scaled = false;  ///< the anchor or something above it changes its scale
        glm::mat4 offset{1};
    };

    const Scene& scene_;
    const Moment& moment_;
    const Motion& motion_;
    const std::vector<glm::mat4>& worlds_;
    std::vector<Still> still_;
    std::vector<std::vector<uint32_t>> first_ids_;
    std::vector<uint32_t> objects_;
    bool has_colors_ = false, has_tangents_ = false;
    std::set<int> generated_;                  ///< nodes that are placed by passes of their own
    std::vector<int> surfaces_;                ///< nodes as of Assembly::surfaces
    std::map<int, std::vector<Place>> fixed_;  ///< by anchor
    std::map<int, std::vector<int>> shared_;   ///< nodes by mesh
    std::map<std::pair<int, int>, std::vector<Place>> deforming_;
    Assembly out_;
};

}  // namespace

double mean_edge(uint64_t triangles, double area) {
    return std::sqrt((area > 1e-60 ? area : 1e-60) / double(std::max<uint64_t>(triangles, 1)));
}

uint32_t serving_resolution(uint64_t triangles, double longest, double inverse_edges, bool rebuilt) {
    // A round body has 3.4 times the area of a square across it; the blobs that were measured are round
    // (docs/lab_notes.md, "The choice of N").
    const double count = double(triangles), across = longest * inverse_edges / std::max(count, 1.0);
    const double spread = std::clamp(3.4 * across * across, count, 16 * count);
    const double voxels = (rebuilt ? 3.25 : 6) * std::cbrt(spread);
    return uint32_t(std::clamp(std::ceil(voxels / 16), 1.0, 64.0)) * 16;
}

uint32_t Assembly::bodies_triangles() const {
    uint32_t triangles = 0;
    for (const Body& body : bodies) triangles += body.triangles;
    return triangles;
}

Assembly Assembly::without_geometry() const {
    Assembly out;
    out.bodies = bodies;
    out.fixed = fixed;
    out.instances = instances;
    out.shown = shown;
    return out;
}

Assembly assemble(const Scene& scene, const Moment& moment, const Motion& motion) {
    return Assembler(scene, moment, motion).take();
}

}  // namespace peelray
