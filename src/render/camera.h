// The camera's part of the frame constants.
#pragma once

#include "params.h"
#include "scene/scene.h"

namespace peelray {

/// Fills eye, right, up, forward, near, far and orthographic. Throws Error for a view without direction (eye = look, up
/// along the view, a field of view outside (0°, 180°)).
void describe_camera(Frame& frame, const Camera& camera, float aspect, const glm::vec3& lower, const glm::vec3& upper);

}  // namespace peelray
