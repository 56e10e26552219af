// The planes of samples by voxel, taken apart on the CPU as the traversal takes them apart.
#pragma once

#include <bit>
#include <cstdint>
#include <glm/glm.hpp>
#include <glm/gtc/packing.hpp>

namespace peelray::test {

/// normal · p = w for p in voxels from the voxel's centre.
struct SamplePlane {
    glm::vec3 normal;
    float w;
};

inline glm::vec3 half_normal(uint32_t xy, uint32_t z) {
    return {glm::unpackHalf2x16(xy), glm::unpackHalf2x16(z).x};
}
/// Of conservative samples (ldcPackPatch).
inline SamplePlane plane_of_patch(const glm::uvec4& data) {
    return {half_normal(data.x, data.y), std::bit_cast<float>(data.z)};
}
/// Of those of pixel centres in the overlap band (ldcPackSample).
inline SamplePlane plane_of_sample(const glm::uvec2& data) {
    return {half_normal(data.x, data.y), float(data.y >> 16 & 0x7fff) * 5 / 32767 - 2.5f};
}

}  // namespace peelray::test
