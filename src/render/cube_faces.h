// The views through the six faces of a cube, in the order and orientation of shaders/cubemap/cubemap.glsl.
#pragma once

#include "path/frame.h"

namespace peelray {

/// Looks from `eye` through face 2·axis + (1: the negative side). `half`: half the picture's size at distance 1; 1 is
/// the face itself. On negative faces the view is mirrored, as the map's convention has it.
inline void look_through_face(Frame& frame, const glm::vec3& eye, uint32_t face, float half) {
    const int axis = int(face >> 1);
    frame.eye = eye;
    frame.forward = frame.right = frame.up = glm::vec3(0);
    frame.forward[axis] = face & 1 ? -1.0f : 1.0f;
    frame.right[(axis + 1) % 3] = half;
    frame.up[(axis + 2) % 3] = half;
    frame.orthographic = 0;
}

}  // namespace peelray
