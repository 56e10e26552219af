// Layered depth cubes on the GPU, one per body, in the order that a traversal reads (docs/data.md draws the
// structures).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "gpu/buffer.h"
#include "gpu/commands.h"
#include "ldc/base_color.h"
#include "ldc/body_table.h"
#include "ldc/ldc_params.h"
#include "ldc/triangle_buffers.h"
#include "settings/choices.h"

namespace peelray {

/// Triangles that the device holds for `exact` hits by voxel: their corners are one buffer.
uint64_t most_exact_triangles(const Device& device);

/// How a cube is sampled.
enum class Sampling : uint8_t {
    conservative = LDC_CONSERVATIVE,  ///< every pixel that a triangle touches: for `exact` hits
    band = LDC_BAND,                  ///< pixel centres, with the overlap band: for `planar` hits
    centre = LDC_CENTRE,  ///< pixel centres, each triangle in one LDI: for `tolerance` hits (the paper, section 1.2.1)
};

static_assert(unsigned(Traversal::voxel) == PEELRAY_VOXELS && unsigned(Traversal::two_level) == PEELRAY_TWO_LEVEL &&
              unsigned(Traversal::mipmap) == PEELRAY_MIPMAP);

/// Throws Error with what would work instead unless this builder captures all that this sampling asks for.
void check_captures(BuilderKind builder, Sampling sampling);

/// How cubes are built and stored.
struct CubeLayout {
    Traversal traversal = Traversal::voxel;
    glm::uvec2 block{8};        ///< pixels of a block of two_level along u and v: 2 to 32
    bool half_depth = false;    ///< by pixel: depths rounded to half floats, as the paper stores them
    Batch batch = Batch::none;  ///< by pixel
    BuilderKind builder = BuilderKind::compute;
    Routing routing = Routing::geometry;  ///< of abuffer and peel
    bool streams = false;  ///< of what is drawn (drawn_stream.h), not of triangles: samples carry attributes

    bool by_pixel() const { return traversal != Traversal::voxel; }
    bool operator==(const CubeLayout&) const = default;
};

/// The grid of N voxels along the longest side of the box [lower, upper] grown by one voxel on each side; voxels are
/// cubes, each side is rounded up to a multiple of 16 voxels. Throws Error unless 16 ≤ resolution ≤ 2048.
CubeGrid make_grid(const glm::vec3& lower, const glm::vec3& upper, uint32_t resolution);

/// Which voxels become 4³ finer ones, in cubes for `exact` hits by voxel: those that hold more than `above` samples, if
/// some voxel holds more than `from` and there are `most` of them at most. No hit depends on it.
struct Refinement {
    uint32_t above = ~0u, from = 0, most = ~0u;
    bool operator==(const Refinement&) const = default;
};

/// What a build has counted.
struct BuildCounts : LdcCounters {
    uint32_t refined = 0;  ///< voxels that became 4³ finer ones
    uint32_t fine = 0;     ///< samples of finer voxels
};

/// How much of the cubes' tables some bodies take.
struct TableSize {
    uint64_t cells = 0;     ///< 16³-voxel cells; by pixel: pixels
    uint64_t occupied = 0;  ///< of them occupied
    uint64_t nodes = 0;     ///< occupied 4³-voxel nodes, and voxels that are refined
    uint64_t samples = 0;

    /// 8 per cell, or per pixel an offset and half a range.
    uint64_t bytes(uint64_t sample_bytes) const {
        return cells * 8 + (occupied + nodes) * 256 + samples * sample_bytes;
    }
    TableSize operator+(const TableSize& b) const {
        return {cells + b.cells, occupied + b.occupied, nodes + b.nodes, samples + b.samples};
    }
};

/// The samples of all bodies in one order. Builders fill it, a range of bodies at a time.
class Cubes {
  public:
    /// `bodies` in ascending order of their triangles, without gaps; at least one. Throws Error for a resolution out of
    /// range.
    Cubes(Device& device, std::vector<CubeBody> bodies, Sampling sampling, const CubeLayout& layout = {});

    const std::vector<CubeBody>& bodies() const { return table.bodies(); }
    Sampling sampling() const { return sampling_; }
    const CubeLayout& layout() const { return layout_; }
    /// Samples as `exact` hits by voxel read them: in `patches`, not in `samples` and `sample_ids`.
    bool has_patches() const { return sampling_ == Sampling::conservative && !layout_.by_pixel(); }
    uint64_t sample_bytes() const { return has_patches() ? 16 : 12; }
    /// Are triangles tested, not samples alone? Then holes in them are looked for at the hit.
    bool tests_triangles() const;
    /// Levels of the min/max pyramid over the pixels of the largest LDI.
    uint32_t pyramid_levels() const;

    /// Makes room for `size` in all; what the first `kept` entries of each table hold stays. Throws NoRoom where the
    /// device has too little.
    void reserve(Commands& commands, const TableSize& size, const TableSize& kept);

    /// Gives back what the tables have room for beyond `size`, which is what they hold.
    void trim(const TableSize& size);

    BodyTable table;    ///< the bodies, with the grids that the last build gave them
    Buffer top_table;   ///< uvec2 per 16³ cell: bit 31 of x: occupied, y = its number; else an empty box in 16³ cells
    Buffer node_table;  ///< uint32, 64 per occupied 16³ cell: bit 31: occupied node's number; else an empty box
    /// uint32, 64 per occupied node: bit 31: first sample of a list, or bits 31 and 30: block of 64 entries of the
    /// finer voxels; else an empty box in voxels. Behind those of the nodes lie the blocks.
    Buffer voxel_table;
    Buffer pixel_offsets;  ///< by pixel: uint32 per pixel of the three LDIs, and one more: where its samples begin
    Buffer pixel_ranges;   ///< by pixel: vec2 per block, or per cell of the pyramid: least and greatest depth of a hit
    Buffer samples;        ///< uvec2 each: depth, slopes, axis, last-of-list (ldcPackSample); by pixel: depth, slopes
    Buffer sample_ids;     ///< uint32 each: triangle · 4 + axis
    Buffer patches;        ///< uvec4 each: plane, coverage, last-of-list, id (ldcPackPatch)
    Buffer corners;        ///< where there are patches: LdcCorners of every triangle
    bool refined = false;  ///< voxels may be: rays look
    Buffer sample_attributes;  ///< of drawn streams: uvec2 each: normal, colour (LdcCaptured)

  private:
    Device& device_;
    Sampling sampling_;
    CubeLayout layout_;
};

}  // namespace peelray
