// The layered depth cube's parameters: one text for C++ and GLSL (scalar block layout).
#ifndef PEELRAY_CUBE_H
#define PEELRAY_CUBE_H

#ifdef __cplusplus
#include <glm/glm.hpp>
namespace peelray {
using glm::uvec3;
using glm::vec3;
using uint = glm::uint;
#endif

/// Where the cube lies. Voxels are cubes; their number may differ per axis.
struct CubeGrid {
    vec3 origin;      ///< world position of the lower corner of voxel (0, 0, 0)
    float voxel;      ///< edge of a voxel, world units
    uvec3 dims;       ///< voxels along x, y, z: multiples of 16, at most 2048
    float inv_voxel;  ///< 1 / voxel
};

#ifdef __cplusplus
static_assert(sizeof(CubeGrid) == 32);
}  // namespace peelray
#endif
#endif
