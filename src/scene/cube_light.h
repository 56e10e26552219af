// Light from all around a scene that comes with it, on the faces of a cube (EXT_lights_image_based).
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace peelray {

struct Environment;

struct CubeLight {
    uint32_t size = 0;  ///< texels along a side of a face
    /// Radiance on +x, -x, +y, -y, +z, -z, row after row: as a camera in the cube's middle sees them whose picture's
    /// top is +y; of the face +y it is -z, of -y +z, and in both of them the left is +x.
    std::array<std::vector<glm::vec3>, 6> faces;
    glm::dmat3 turn{1};  ///< from the cube's directions to the world's
    float intensity = 1;
};

/// The same as an image all around, in the world.
Environment cube_environment(const CubeLight& light);

}  // namespace peelray
