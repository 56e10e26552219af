#include "scene/scene.h"

#include <glm/gtc/matrix_transform.hpp>

namespace peelray {

glm::dmat4 Placement::matrix(bool precise) const {
    if (precise) return glm::scale(glm::translate(glm::dmat4(1), translation) * glm::mat4_cast(rotation), scale);
    const glm::mat4 turned = glm::translate(glm::mat4(1), glm::vec3(translation)) * glm::mat4_cast(glm::quat(rotation));
    return glm::dmat4(glm::scale(turned, glm::vec3(scale)));
}

}  // namespace peelray
