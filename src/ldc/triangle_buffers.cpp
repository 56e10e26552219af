#include "ldc/triangle_buffers.h"

#include "base/error.h"

namespace peelray {

TriangleBuffers::TriangleBuffers(Device& device, std::span<const glm::vec3> points, std::span<const glm::uvec3> indices)
    : count(uint32_t(indices.size())), vertices(uint32_t(points.size())) {
    // Two bits of a sample's id hold its axis.
    if (indices.size() >= 1u << 30)
        fail("the scene has {} triangles, but cubes hold fewer than 2^30: split the scene", indices.size());
    const MemoryPart part(device, "triangles");
    positions = Buffer(device, "vertex positions", points.size_bytes());
    triangles = Buffer(device, "triangle indices", indices.size_bytes());
    Commands commands(device);
    commands.upload(positions, points);
    commands.upload(triangles, indices);
}

}  // namespace peelray
