#include "motion/bounds.h"

#include <algorithm>
#include <cmath>

#include "motion/animation.h"
#include "motion/motion.h"
#include "scene/deform.h"

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

}  // namespace

Box bounds(const Scene& scene, const Moment& moment) {
    Box box;
    for (size_t n = 0; n < scene.nodes.size(); n++) {
        const Node& node = scene.nodes[n];
        if (node.mesh < 0) continue;
        for (const Primitive& primitive : scene.meshes[size_t(node.mesh)].primitives) {
            const std::vector<glm::vec3> positions = positions_of(scene, moment, n, primitive);
            for_each_vertex(primitive, [&](size_t i) { box.add(positions[i]); });
        }
    }
    return box;
}

Box bounds_over(const Scene& scene, const std::string& which) {
    const std::vector<double> times = moments(find_animations(scene, which));
    const Moment rest = at_rest(scene);
    Box box = bounds(scene, rest);
    if (motion_of(scene, which).generates) {
        box.add(scene.generated.reach.lower);
        box.add(scene.generated.reach.upper);
    }
    const size_t stride = 1 + vertices_of_nodes(scene) * times.size() / most_places;
    std::vector<std::vector<Primitive>> meshes;
    for (const Mesh& mesh : scene.meshes) {
        meshes.emplace_back();
        for (const Primitive& primitive : mesh.primitives) meshes.back().push_back(thinned(primitive, stride));
    }
    for (const double time : times) {
        const Moment moment = moment_of(scene, which, time);
        for (size_t n = 0; n < scene.nodes.size(); n++) {
            const Node& node = scene.nodes[n];
            if (node.mesh < 0) continue;
            for (const Primitive& primitive : meshes[size_t(node.mesh)]) {
                if (is_rigid(primitive, node) && moment.worlds[n] == rest.worlds[n]) continue;
                // Positions beyond the range of floats are refused when that moment is shown.
                for (const glm::vec3& p : positions_of(scene, moment, n, primitive))
                    if (is_finite(p)) box.add(p);
            }
        }
    }
    return box;
}

}  // namespace peelray
