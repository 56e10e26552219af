#include "scene/scene.h"

#include <glm/gtc/matrix_transform.hpp>

namespace peelray {

glm::mat4 Placement::matrix() const {
    return glm::scale(glm::translate(glm::mat4(1), translation) * glm::mat4_cast(rotation), scale);
}

}  // namespace peelray
