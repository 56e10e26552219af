#include "ldc/cube.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "gpu/commands.h"

namespace peelray {

TriangleBuffers::TriangleBuffers(Device& device, std::span<const glm::vec3> vertices,
                                 std::span<const glm::uvec3> indices, const glm::vec3& lower, const glm::vec3& upper)
    : count(uint32_t(indices.size())), lower(lower), upper(upper) {
    // Two bits of a sample's id hold its axis.
    if (indices.size() >= 1u << 30)
        fail("the scene has {} triangles, but a cube holds fewer than 2^30: split the scene", indices.size());
    positions = Buffer(device, "vertex positions", vertices.size_bytes());
    triangles = Buffer(device, "triangle indices", indices.size_bytes());
    Commands commands(device);
    commands.upload(positions, vertices);
    commands.upload(triangles, indices);
}

CubeGrid make_grid(const glm::vec3& lower, const glm::vec3& upper, uint32_t resolution) {
    if (resolution < 16 || resolution > 2048)
        fail("the LDI resolution {} is out of range: choose 16 to 2048 (--ldc)", resolution);
    const uint32_t n = (resolution + 15) / 16 * 16;
    const glm::dvec3 size = glm::dvec3(upper) - glm::dvec3(lower);
    double longest = std::max({size.x, size.y, size.z});
    // A scene thinner than the rounding of its own coordinates still needs voxels of some size.
    const glm::dvec3 reach = glm::max(glm::abs(glm::dvec3(lower)), glm::abs(glm::dvec3(upper)));
    longest = std::max({longest, std::max({reach.x, reach.y, reach.z}) * 1e-6, 1e-30});
    CubeGrid grid{};
    grid.voxel = float(longest / (n - 2));
    grid.inv_voxel = 1 / grid.voxel;
    for (int axis = 0; axis < 3; axis++) {
        const double voxels = size[axis] / grid.voxel + 2 - 1e-3;
        grid.dims[axis] = std::clamp(uint32_t(std::ceil(voxels / 16)) * 16, 16u, n);
        const double centre = 0.5 * (double(lower[axis]) + double(upper[axis]));
        grid.origin[axis] = float(centre - 0.5 * double(grid.dims[axis]) * grid.voxel);
    }
    return grid;
}

Cube::Bytes Cube::bytes() const {
    const uint64_t tops = uint64_t(grid.dims.x / 16) * (grid.dims.y / 16) * (grid.dims.z / 16);
    return {tops * 8, uint64_t(counts.tops) * 256, uint64_t(counts.nodes) * 256, uint64_t(counts.fragments) * 12};
}

}  // namespace peelray
