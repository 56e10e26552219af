// Layered depth cubes on the GPU, one per body, in the by-voxel order (docs/data.md draws the structure).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "gpu/buffer.h"
#include "gpu/commands.h"
#include "ldc/base_color.h"
#include "params.h"

namespace peelray {

/// Triangles on the device, in the spaces of their bodies.
struct TriangleBuffers {
    Buffer positions;    ///< vec3 each, tightly packed
    Buffer triangles;    ///< three uint32 indices each
    uint32_t count = 0;  ///< triangles, < 2^30
    /// Where they have holes; must outlive this. Null: no material is masked.
    const BaseColorBuffers* masks = nullptr;

    TriangleBuffers() = default;
    /// Uploads. Throws Error beyond 2^30 triangles or the device's memory.
    TriangleBuffers(Device& device, std::span<const glm::vec3> vertices, std::span<const glm::uvec3> indices);
};

/// Triangles that share a cube, in a space of their own.
struct CubeBody {
    uint32_t first_triangle = 0, triangles = 0;
    uint32_t resolution = 512;     ///< voxels along the longest side: 16 to 2048, rounded up to a multiple of 16
    glm::vec3 lower{0}, upper{0};  ///< bounds; of bodies that deform: as they are now, for a guess of what they need
};

/// The next multiple of 16. Throws Error unless 16 ≤ resolution ≤ 2048.
uint32_t round_resolution(uint32_t resolution);

/// How a cube is sampled.
enum class Sampling : uint8_t {
    conservative,  ///< every pixel that a triangle touches: for `exact` hits
    centre,        ///< pixel centres, with the overlap band: for `planar` hits
};

/// The grid of N voxels along the longest side of the box [lower, upper] grown by one voxel on each side; voxels are
/// cubes, each side is rounded up to a multiple of 16 voxels. Throws Error unless 16 ≤ resolution ≤ 2048.
CubeGrid make_grid(const glm::vec3& lower, const glm::vec3& upper, uint32_t resolution);

/// How much of the cubes' tables some bodies take.
struct TableSize {
    uint64_t tops = 0;      ///< 16³-voxel cells
    uint64_t occupied = 0;  ///< of them occupied
    uint64_t nodes = 0;     ///< occupied 4³-voxel nodes
    uint64_t samples = 0;

    uint64_t bytes() const { return tops * 8 + (occupied + nodes) * 256 + samples * 12; }
    TableSize operator+(const TableSize& b) const {
        return {tops + b.tops, occupied + b.occupied, nodes + b.nodes, samples + b.samples};
    }
};

/// The by-voxel order of all bodies: what the `voxel` traversal reads. Builders fill it, a range of bodies at a time.
class Cubes {
  public:
    /// `bodies` in ascending order of their triangles, without gaps; at least one. Throws Error for a resolution out of
    /// range.
    Cubes(Device& device, std::vector<CubeBody> bodies, Sampling sampling);

    const std::vector<CubeBody>& bodies() const { return bodies_; }
    Sampling sampling() const { return sampling_; }

    /// Makes room for `size` in all; what the first `kept` entries of each table hold stays.
    void reserve(Commands& commands, const TableSize& size, const TableSize& kept);

    /// LdcBody of every body as the last build left them.
    std::vector<LdcBody> download_bodies(Commands& commands) const;

    /// Bytes of device memory held.
    uint64_t held_bytes() const;

    Buffer body_table;              ///< LdcBody each
    Buffer body_lower, body_upper;  ///< bounds: uvec3 each, as orderedBits of shaders/bounds.glsl
    Buffer top_table;    ///< uvec2 per 16³ cell: bit 31 of x: occupied, y = its number; else an empty box in 16³ cells
    Buffer node_table;   ///< uint32, 64 per occupied 16³ cell: bit 31: occupied node's number; else an empty box
    Buffer voxel_table;  ///< uint32, 64 per occupied node: bit 31: first sample of a list; else an empty box in voxels
    Buffer samples;      ///< uvec2 each: depth, coverage, slopes, axis, last-of-list (ldcPackSample)
    Buffer sample_ids;   ///< uint32 each: triangle · 4 + axis

  private:
    Device& device_;
    std::vector<CubeBody> bodies_;
    Sampling sampling_;
};

}  // namespace peelray
