// The layered depth cube on the GPU, in the by-voxel order (docs/data.md draws the structure).
#pragma once

#include <cstdint>
#include <span>

#include "gpu/buffer.h"
#include "params.h"

namespace peelray {

/// What a builder reads: world-space triangles on the device.
struct TriangleBuffers {
    Buffer positions;              ///< vec3 each, tightly packed
    Buffer triangles;              ///< three uint32 indices each
    uint32_t count = 0;            ///< triangles, < 2^30
    glm::vec3 lower{0}, upper{0};  ///< bounds of what the triangles may reach

    /// Uploads; `lower`, `upper` as given. Throws Error beyond 2^30 triangles or the device's memory.
    TriangleBuffers(Device& device, std::span<const glm::vec3> vertices, std::span<const glm::uvec3> indices,
                    const glm::vec3& lower, const glm::vec3& upper);
};

/// How a cube is sampled.
enum class Sampling : uint8_t {
    conservative,  ///< every pixel that a triangle touches: for `exact` hits
    centre,        ///< pixel centres, with the overlap band: for `planar` hits
};

/// The grid of N voxels along the longest side of the box [lower, upper] grown by one voxel on each side; voxels are
/// cubes, each side is rounded up to a multiple of 16 voxels. Throws Error unless 16 ≤ resolution ≤ 2048.
CubeGrid make_grid(const glm::vec3& lower, const glm::vec3& upper, uint32_t resolution);

/// The by-voxel order: what the `voxel` traversal reads.
struct Cube {
    CubeGrid grid{};
    Sampling sampling = Sampling::conservative;
    Buffer top_table;  ///< uvec2 per 16³ cell: bit 31 of x: occupied, y = its number; else an empty box in 16³ cells
    Buffer
        node_table;  ///< uint32, 64 per occupied 16³ cell: bit 31: occupied node's number; else an empty box in nodes
    Buffer voxel_table;  ///< uint32, 64 per occupied node: bit 31: first sample of a list; else an empty box in voxels
    Buffer samples;      ///< uvec2 each: depth, coverage, slopes, axis, last-of-list (ldcPackSample)
    Buffer sample_ids;   ///< uint32 each: triangle · 4 + axis
    LdcCounters counts{};  ///< of the last finished build

    /// Bytes that the structure holds in use, by table.
    struct Bytes {
        uint64_t top, node, voxel, samples;
        uint64_t total() const { return top + node + voxel + samples; }
    };
    Bytes bytes() const;
};

}  // namespace peelray
