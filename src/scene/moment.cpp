#include "scene/moment.h"

#include "scene/transform.h"

namespace peelray {

const Moment::Surface* Moment::surface_of(int node) const {
    for (const Surface& surface : surfaces)
        if (surface.node == node) return &surface;
    return nullptr;
}

/// Products of matrices in the precision of `Matrix`; `roots` makes those of nodes without a parent.
template <typename Matrix, typename Root>
static std::vector<Matrix> products(const Scene& scene, const std::vector<glm::dmat4>& locals, Root root) {
    std::vector<Matrix> worlds;
    worlds.reserve(scene.nodes.size());
    for (size_t i = 0; i < scene.nodes.size(); i++) {
        const int parent = scene.nodes[i].parent;
        worlds.push_back(parent < 0 ? root(locals[i]) : worlds[size_t(parent)] * Matrix(locals[i]));
    }
    return worlds;
}

std::vector<glm::dmat4> exact_world_matrices(const Scene& scene, const std::vector<glm::dmat4>& locals) {
    return products<glm::dmat4>(scene, locals, [&](glm::dmat4 local) {
        local[3] -= glm::dvec4(scene.origin, 0);
        return local;
    });
}

std::vector<glm::mat4> world_matrices(const Scene& scene, const std::vector<glm::dmat4>& locals) {
    if (!scene.precise)
        return products<glm::mat4>(scene, locals, [](const glm::dmat4& local) { return glm::mat4(local); });
    const std::vector<glm::dmat4> exact = exact_world_matrices(scene, locals);
    return {exact.begin(), exact.end()};
}

void carry_along(
    const Scene& scene, const Moment& moment, std::vector<Camera>& cameras, std::vector<Light>& lights,
    const std::function<double(const Camera& before, const glm::dvec3& eye, const glm::dvec3& ahead)>& distance) {
    std::vector<glm::dmat4> exact;
    if (scene.precise) exact = exact_world_matrices(scene, moment.locals);
    for (size_t i = 0; i < scene.nodes.size(); i++) {
        const Node& node = scene.nodes[i];
        if (node.camera >= 0) {
            const BasicPose<double> pose(scene.precise ? exact[i] : glm::dmat4(moment.worlds[i]));
            Camera& camera = cameras[size_t(node.camera)];
            camera.look = pose.at + pose.ahead * distance(camera, pose.at, pose.ahead);
            camera.eye = pose.at;
            camera.up = pose.up;
        }
        if (node.light >= 0) {
            const Pose pose(moment.worlds[i]);
            Light& light = lights[size_t(node.light)];
            light.position = pose.at;
            light.direction = pose.ahead;
        }
    }
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
