#include "motion/bounds.h"

#include <algorithm>
#include <cmath>

#include "motion/animation.h"
#include "motion/motion.h"
#include "path/shading_numbers.h"
#include "scene/deform.h"
#include "scene/sampling.h"

namespace peelray {
namespace {

constexpr size_t most_even_moments = 33, most_key_moments = 33;
// Vertices times moments: a tenth of a second for a skin.
constexpr size_t most_places = size_t(1) << 20;

bool is_finite(const glm::vec3& p) {
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

/// Calls `visit(vertex)` once for every vertex that a triangle has.
template <typename Visit>
void for_each_vertex(const Primitive& primitive, Visit visit) {
    std::vector<bool> used(primitive.positions.size(), false);
    for (const glm::uvec3& t : primitive.triangles)
        for (int k = 0; k < 3; k++) used[t[k]] = true;
    for (size_t i = 0; i < used.size(); i++)
        if (used[i]) visit(i);
}

/// Every `stride`-th vertex that a triangle has, and those that lie farthest along each axis, in order.
std::vector<size_t> chosen_vertices(const Primitive& primitive, size_t stride) {
    std::vector<size_t> all, chosen;
    for_each_vertex(primitive, [&](size_t i) { all.push_back(i); });
    for (size_t i = 0; i < all.size(); i += stride) chosen.push_back(all[i]);
    if (stride == 1 || all.empty()) return chosen;
    for (int axis = 0; axis < 3; axis++) {
        const auto before = [&](size_t a, size_t b) {
            return primitive.positions[a][axis] < primitive.positions[b][axis];
        };
        const auto [least, greatest] = std::minmax_element(all.begin(), all.end(), before);
        chosen.insert(chosen.end(), {*least, *greatest});
    }
    std::sort(chosen.begin(), chosen.end());
    chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
    return chosen;
}

template <typename T>
std::vector<T> picked(const std::vector<T>& from, const std::vector<size_t>& indices) {
    std::vector<T> out;
    if (from.empty()) return out;
    for (const size_t i : indices) out.push_back(from[i]);
    return out;
}

/// As much of a primitive as deform() needs to place some of its vertices.
Primitive thinned(const Primitive& from, size_t stride) {
    const std::vector<size_t> indices = chosen_vertices(from, stride);
    Primitive out;
    out.positions = picked(from.positions, indices);
    out.normals = picked(from.normals, indices);
    out.joints = picked(from.joints, indices);
    for (const MorphTarget& target : from.targets) out.targets.push_back({picked(target.positions, indices), {}});
    return out;
}

std::vector<double> moments(const std::vector<const Animation*>& animations) {
    std::vector<double> keys, moments;
    float duration = 0;
    for (const Animation* animation : animations) {
        duration = std::max(duration, animation->duration);
        for (const AnimationChannel& channel : animation->channels)
            keys.insert(keys.end(), channel.times.begin(), channel.times.end());
    }
    std::sort(keys.begin(), keys.end());
    keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
    // Keys are where jumps land and swings turn round.
    const size_t count = std::min(keys.size(), most_key_moments);
    for (size_t i = 0; i < count; i++) moments.push_back(keys[i * (keys.size() - 1) / std::max<size_t>(count - 1, 1)]);
    // What has no end has no keys either.
    for (size_t i = 0; i < most_even_moments && std::isfinite(duration); i++)
        moments.push_back(double(duration) * double(i) / double(most_even_moments - 1));
    return moments;
}

size_t vertices_of_nodes(const Scene& scene) {
    size_t count = 0;
    for (const Node& node : scene.nodes)
        if (node.mesh >= 0)
            for (const Primitive& primitive : scene.meshes[size_t(node.mesh)].primitives)
                count += primitive.positions.size();
    return count;
}

/// Where the vertices of a node's primitive are at a moment, without their normals.
std::vector<glm::vec3> positions_of(const Scene& scene, const Moment& moment, size_t n, const Primitive& primitive) {
    const Node& node = scene.nodes[n];
    if (!is_rigid(primitive, node))
        return deform(scene, node, primitive, weights_of(scene, moment, n), moment.worlds, moment.worlds[n]).positions;
    const Moment::Surface* surface = moment.surface_of(int(n));
    const std::vector<glm::vec3>& positions = surface ? surface->positions : primitive.positions;
    std::vector<glm::vec3> out;
    out.reserve(positions.size());
    for (const glm::vec3& p : positions) out.push_back(glm::vec3(moment.worlds[n] * glm::vec4(p, 1)));
    return out;
}

/// Can the alpha test leave anything of a primitive's surface?
bool leaves_something(const Scene& scene, const Primitive& primitive) {
    const Material& material = scene.materials[primitive.material];
    const double least = double(material.alpha_cutoff) - ALPHA_ROUNDING;
    if (material.alpha_cutoff <= 0) return true;
    float corners = primitive.colors.empty() ? 1 : 0;
    for (const glm::vec4& color : primitive.colors) corners = std::max(corners, color.w);
    const double most = double(material.alpha) * double(corners);
    if (most < least || !material.base_color_texture) return most >= least;
    return most * greatest_value(scene.textures[size_t(material.base_color_texture.texture)], 3) >= least;
}

/// The primitives that count, mesh by mesh.
std::vector<std::vector<const Primitive*>> counted_primitives(const Scene& scene, Counted counted) {
    std::vector<std::vector<const Primitive*>> meshes;
    for (const Mesh& mesh : scene.meshes) {
        meshes.emplace_back();
        for (const Primitive& primitive : mesh.primitives)
            if (counted == Counted::all || leaves_something(scene, primitive)) meshes.back().push_back(&primitive);
    }
    return meshes;
}

/// Positions beyond the range of floats are refused when that moment is shown.
void visit_finite(std::vector<glm::vec3> positions, const PointVisitor& visit) {
    std::erase_if(positions, [](const glm::vec3& p) { return !is_finite(p); });
    visit(positions);
}

void visit_used(const Scene& scene, const Moment& moment, size_t n, const Primitive& primitive,
                const PointVisitor& visit) {
    const std::vector<glm::vec3> positions = positions_of(scene, moment, n, primitive);
    std::vector<glm::vec3> used;
    used.reserve(positions.size());
    for_each_vertex(primitive, [&](size_t i) { used.push_back(positions[i]); });
    visit_finite(std::move(used), visit);
}

/// What the nodes of a scene reach in an animation, moment by moment.
class Reach {
  public:
    Reach(const Scene& scene, Counted counted, size_t moments)
        : scene_(scene),
          rest_(at_rest(scene)),
          primitives_(counted_primitives(scene, counted)),
          has_rested_(scene.nodes.size(), false) {
        const size_t stride = 1 + vertices_of_nodes(scene) * moments / most_places;
        for (const auto& mesh : primitives_) {
            thinned_.emplace_back();
            for (const Primitive* primitive : mesh) thinned_.back().push_back(thinned(*primitive, stride));
        }
    }

    void visit_at(const Moment& moment, const PointVisitor& visit) {
        for (size_t n = 0; n < scene_.nodes.size(); n++)
            if (scene_.nodes[n].mesh >= 0) visit_node(moment, n, visit);
    }

  private:
    void visit_node(const Moment& moment, size_t n, const PointVisitor& visit) {
        const size_t mesh = size_t(scene_.nodes[n].mesh);
        // What stands still is looked at once, and then all of it.
        const bool rests = moment.worlds[n] == rest_.worlds[n], first = rests && !has_rested_[n];
        has_rested_[n] = has_rested_[n] || rests;
        for (size_t i = 0; i < primitives_[mesh].size(); i++) {
            const bool rigid = is_rigid(*primitives_[mesh][i], scene_.nodes[n]);
            if (rigid && first)
                visit_used(scene_, moment, n, *primitives_[mesh][i], visit);
            else if (!rigid || !rests)
                visit_finite(positions_of(scene_, moment, n, thinned_[mesh][i]), visit);
        }
    }

    const Scene& scene_;
    Moment rest_;
    std::vector<std::vector<const Primitive*>> primitives_;
    std::vector<std::vector<Primitive>> thinned_;
    std::vector<bool> has_rested_;
};

}  // namespace

void visit_points(const Scene& scene, const Moment& moment, size_t nodes, Counted counted, const PointVisitor& visit) {
    const auto meshes = counted_primitives(scene, counted);
    for (size_t n = 0; n < nodes; n++) {
        if (scene.nodes[n].mesh < 0) continue;
        for (const Primitive* primitive : meshes[size_t(scene.nodes[n].mesh)])
            visit_used(scene, moment, n, *primitive, visit);
    }
}

Box bounds(const Scene& scene, const Moment& moment) {
    Box box;
    visit_points(scene, moment, scene.nodes.size(), Counted::all, [&](std::span<const glm::vec3> points) {
        for (const glm::vec3& p : points) box.add(p);
    });
    return box;
}

void visit_reach(const Scene& scene, const std::string& which, Counted counted, const PointVisitor& visit) {
    if (which.empty()) return visit_points(scene, at_rest(scene), scene.nodes.size(), counted, visit);
    std::vector<double> times = moments(find_animations(scene, which));
    // What has no end is shown by its reach; the rest of the scene stands.
    if (times.empty()) times = {0};
    Reach reach(scene, counted, times.size());
    for (const double time : times) reach.visit_at(moment_of(scene, which, time), visit);
    if (!motion_of(scene, which).generates) return;
    const auto& box = scene.generated.reach;
    std::vector<glm::vec3> corners;
    for (int i = 0; i < 8; i++)
        corners.emplace_back(i & 1 ? box.upper.x : box.lower.x, i & 2 ? box.upper.y : box.lower.y,
                             i & 4 ? box.upper.z : box.lower.z);
    visit(corners);
}

}  // namespace peelray
