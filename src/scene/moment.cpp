#include "scene/moment.h"

namespace peelray {

const Moment::Surface* Moment::surface_of(int node) const {
    for (const Surface& surface : surfaces)
        if (surface.node == node) return &surface;
    return nullptr;
}

std::vector<glm::mat4> world_matrices(const Scene& scene, const std::vector<glm::mat4>& locals) {
    std::vector<glm::mat4> worlds;
    worlds.reserve(scene.nodes.size());
    for (size_t i = 0; i < scene.nodes.size(); i++) {
        const int parent = scene.nodes[i].parent;
        worlds.push_back(parent < 0 ? locals[i] : worlds[size_t(parent)] * locals[i]);
    }
    return worlds;
}

Moment at_rest(const Scene& scene) {
    Moment moment;
    moment.locals.reserve(scene.nodes.size());
    moment.weights.reserve(scene.nodes.size());
    for (const Node& node : scene.nodes) {
        moment.locals.push_back(node.local);
        moment.weights.push_back(node.weights);
    }
    moment.worlds = world_matrices(scene, moment.locals);
    moment.cameras = scene.cameras;
    moment.lights = scene.lights;
    return moment;
}

const std::vector<float>& weights_of(const Scene& scene, const Moment& moment, size_t node) {
    const Node& shown = scene.nodes[node];
    const std::vector<float>& own = moment.weights[shown.is_instance ? size_t(shown.parent) : node];
    return own.empty() ? scene.meshes[size_t(scene.nodes[node].mesh)].weights : own;
}

}  // namespace peelray
