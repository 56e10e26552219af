#include "scene/origin.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <map>
#include <utility>

#include "scene/box.h"
#include "scene/moment.h"

namespace peelray {
namespace {

struct DoubleBox {
    glm::dvec3 lower{INFINITY}, upper{-INFINITY};

    void add(const glm::dvec3& p) {
        lower = glm::min(lower, p);
        upper = glm::max(upper, p);
    }
    /// The corners of a box that a matrix moves.
    void add(const DoubleBox& box, const glm::dmat4& matrix) {
        if (box.empty()) return;
        for (int i = 0; i < 8; i++)
            add(glm::dvec3(matrix * glm::dvec4(i & 1 ? box.upper.x : box.lower.x, i & 2 ? box.upper.y : box.lower.y,
                                               i & 4 ? box.upper.z : box.lower.z, 1)));
    }
    bool empty() const { return !(lower.x <= upper.x); }
    glm::dvec3 middle() const { return 0.5 * lower + 0.5 * upper; }
    double longest() const { return reach_of(upper - lower); }
};

DoubleBox box_of(const Mesh& mesh) {
    DoubleBox box;
    for (const Primitive& primitive : mesh.primitives)
        for (const glm::uvec3& t : primitive.triangles)
            for (int k = 0; k < 3; k++) box.add(primitive.positions[t[k]]);
    return box;
}

/// Where everything is, in double precision.
class Survey {
  public:
    Survey(const Scene& scene, const std::vector<glm::dmat4>& locals)
        : scene_(scene), worlds_(exact_world_matrices(scene, locals)), matters_(scene.nodes.size()) {
        for (const Mesh& mesh : scene.meshes) meshes_.push_back(box_of(mesh));
        for (size_t i = 0; i < scene.nodes.size(); i++) {
            const Node& node = scene.nodes[i];
            matters_[i] = matters_[i] || node.mesh >= 0 || node.camera >= 0;
            if (node.mesh >= 0) add_mesh(i);
        }
        for (size_t i = scene.nodes.size(); i-- > 0;) {
            if (!matters_[i]) continue;
            reach_ = std::max(reach_, reach_of(glm::dvec3(worlds_[i][3])));
            if (scene.nodes[i].parent >= 0) matters_[size_t(scene.nodes[i].parent)] = true;
        }
        if (!all_.empty()) reach_ = std::max(reach_, reach_of(all_.middle()));
    }

    /// Is something far away on the way to the world, or at its end?
    bool is_far() const { return !all_.empty() && std::isfinite(reach_) && peelray::is_far(reach_, all_.longest()); }
    glm::dvec3 origin() const {
        return peelray::is_far(reach_of(all_.middle()), all_.longest()) ? all_.middle() : glm::dvec3(0);
    }
    /// How far meshes are to be moved in their own space, each; 0: not.
    std::vector<glm::dvec3> offsets() const {
        std::vector<glm::dvec3> offsets;
        for (const DoubleBox& box : meshes_)
            offsets.push_back(!box.empty() && peelray::is_far(reach_of(box.middle()), all_.longest()) ? box.middle()
                                                                                                      : glm::dvec3(0));
        return offsets;
    }

  private:
    void add_mesh(size_t i) {
        const Node& node = scene_.nodes[i];
        const DoubleBox& box = meshes_[size_t(node.mesh)];
        if (!box.empty()) reach_ = std::max(reach_, reach_of(box.middle()));
        if (node.skin < 0) return all_.add(box, worlds_[i]);
        const Skin& skin = scene_.skins[size_t(node.skin)];
        for (size_t k = 0; k < skin.joints.size(); k++) {
            matters_[size_t(skin.joints[k])] = true;
            all_.add(box, worlds_[size_t(skin.joints[k])] * glm::dmat4(skin.inverse_bind[k]));
        }
    }

    const Scene& scene_;
    const std::vector<glm::dmat4> worlds_;
    std::vector<DoubleBox> meshes_;
    std::vector<bool> matters_;  ///< whether anything that is seen, or sees, depends on the node
    DoubleBox all_;
    double reach_ = 0;
};

/// Moves meshes in their own space, and shows each with a child of its nodes that moves it back.
class MeshMover {
  public:
    MeshMover(Scene& scene, std::vector<glm::dvec3> offsets) : scene_(scene), offsets_(std::move(offsets)) {
        for (size_t i = 0; i < offsets_.size(); i++)
            if (is_moved(int(i)))
                for (Primitive& primitive : scene.meshes[i].primitives)
                    for (glm::vec3& p : primitive.positions) p = glm::vec3(glm::dvec3(p) - offsets_[i]);
        for (Node& node : std::exchange(scene.nodes, {})) add(std::move(node));
        for (Skin& skin : scene.skins)
            for (int& joint : skin.joints) joint = places_[size_t(joint)];
        for (Animation& animation : scene.animations)
            for (AnimationChannel& channel : animation.channels) {
                const bool of_mesh = channel.path == AnimationChannel::Path::weights;
                channel.node = (of_mesh ? carriers_ : places_)[size_t(channel.node)];
            }
    }

  private:
    bool is_moved(int mesh) const { return mesh >= 0 && offsets_[size_t(mesh)] != glm::dvec3(0); }

    void add(Node node) {
        std::vector<Node>& nodes = scene_.nodes;
        if (node.parent >= 0) node.parent = places_[size_t(node.parent)];
        places_.push_back(int(nodes.size()));
        nodes.push_back(std::move(node));
        if (is_moved(nodes.back().mesh) && nodes.back().is_instance) {
            move_instance(nodes.back());
        } else if (is_moved(nodes.back().mesh)) {
            Node& from = nodes.back();
            Node child;
            child.name = from.name;
            child.parent = places_.back();
            child.mesh = std::exchange(from.mesh, -1);
            child.weights = from.weights;
            child.local[3] = glm::dvec4(offsets_[size_t(child.mesh)], 1);
            child.skin = std::exchange(from.skin, -1);
            if (child.skin >= 0) child.skin = skin_of(child.skin, child.mesh);
            nodes.push_back(std::move(child));
        }
        carriers_.push_back(int(nodes.size()) - 1);
    }

    /// No animation moves an instance, so that it can move its mesh back by itself; a skin's joints do that for it.
    void move_instance(Node& node) {
        if (node.skin >= 0)
            node.skin = skin_of(node.skin, node.mesh);
        else
            node.local = node.local * glm::translate(glm::dmat4(1), offsets_[size_t(node.mesh)]);
    }

    /// The skin as the moved mesh needs it.
    int skin_of(int skin, int mesh) {
        const auto [found, is_new] = skins_.try_emplace({skin, mesh}, int(scene_.skins.size()));
        if (!is_new) return found->second;
        Skin moved = scene_.skins[size_t(skin)];
        const glm::dmat4 back = glm::translate(glm::dmat4(1), offsets_[size_t(mesh)]);
        for (glm::mat4& inverse : moved.inverse_bind) inverse = glm::mat4(glm::dmat4(inverse) * back);
        scene_.skins.push_back(std::move(moved));
        return found->second;
    }

    Scene& scene_;
    const std::vector<glm::dvec3> offsets_;
    std::vector<int> places_, carriers_;  ///< of nodes by their old index: where they are, and what shows their mesh
    std::map<std::pair<int, int>, int> skins_;
};

/// Of all vertices at rest, the skinned ones where their nodes are.
glm::vec3 middle_of(const Scene& scene, const std::vector<glm::mat4>& worlds) {
    Box box;
    for (size_t i = 0; i < worlds.size(); i++) {
        if (scene.nodes[i].mesh < 0) continue;
        for (const Primitive& primitive : scene.meshes[size_t(scene.nodes[i].mesh)].primitives)
            for (const glm::vec3& p : primitive.positions) box.add(glm::vec3(worlds[i] * glm::vec4(p, 1)));
    }
    return 0.5f * box.lower + 0.5f * box.upper;
}

}  // namespace

void settle_origin(Scene& scene, const std::vector<ExactNode>& exact) {
    std::vector<glm::dmat4> locals;
    for (size_t i = 0; i < scene.nodes.size(); i++)
        locals.push_back(exact.empty() ? scene.nodes[i].local : exact[i].local);
    if (const Survey survey(scene, locals); survey.is_far()) {
        scene.precise = true;
        scene.origin = survey.origin();
        for (size_t i = 0; i < exact.size(); i++) {
            scene.nodes[i].local = exact[i].local;
            scene.nodes[i].rest = exact[i].rest;
        }
        const std::vector<glm::dvec3> offsets = survey.offsets();
        if (std::any_of(offsets.begin(), offsets.end(), [](const glm::dvec3& o) { return o != glm::dvec3(0); }))
            MeshMover(scene, offsets);
    }
    if (scene.cameras.empty() && scene.lights.empty()) return;
    const Moment rest = at_rest(scene);
    const glm::dvec3 middle = scene.cameras.empty() ? glm::dvec3(0) : glm::dvec3(middle_of(scene, rest.worlds));
    // A glTF camera has no target; ours looks at the point of its axis that is nearest to the middle of the scene.
    carry_along(scene, rest, scene.cameras, scene.lights,
                [&](const Camera&, const glm::dvec3& eye, const glm::dvec3& ahead) {
                    const double distance = glm::dot(middle - eye, ahead);
                    return std::isfinite(distance) && distance > 1e-3 ? distance : 1;
                });
}

}  // namespace peelray
