#include "scene/scene.h"

#include <glm/gtc/matrix_transform.hpp>

namespace peelray {

glm::mat4 Placement::matrix() const {
    return glm::scale(glm::translate(glm::mat4(1), translation) * glm::mat4_cast(rotation), scale);
}

std::vector<glm::mat4> world_matrices(const Scene& scene) {
    std::vector<glm::mat4> worlds;
    worlds.reserve(scene.nodes.size());
    for (const Node& node : scene.nodes)
        worlds.push_back(node.parent < 0 ? node.local : worlds[size_t(node.parent)] * node.local);
    return worlds;
}

}  // namespace peelray
