// The `compute` builder: rasterises the scene into the cube with compute shaders.
#pragma once

#include "gpu/commands.h"
#include "ldc/cube.h"

namespace peelray {

/// Builds cubes in the by-voxel order. One builder serves many frames; its scratch memory is kept and grows as needed.
///
///     do {
///         builder.record(commands, triangles, cube);
///         commands.submit();            // with whatever else belongs to the frame
///     } while (!builder.finish(cube));  // false: something did not fit; it has room now
class ComputeBuilder {
  public:
    explicit ComputeBuilder(Device& device);

    /// Sets the cube's grid and sampling and makes room: a guess from the triangles' count at first, 1.5 times the last
    /// need later.
    void prepare(Cube& cube, const TriangleBuffers& triangles, uint32_t resolution, Sampling sampling);

    /// Records all passes of one build into the group "build".
    void record(Commands& commands, const TriangleBuffers& triangles, Cube& cube);

    /// After the submission: true if everything fitted. Otherwise the buffers have grown and the frame must be recorded
    /// again. Throws Error where a software device cannot sort what crowds into one voxel.
    bool finish(Cube& cube);

    /// prepare, record, submit and finish until it fits.
    void build(Commands& commands, const TriangleBuffers& triangles, Cube& cube, uint32_t resolution,
               Sampling sampling);

    /// Bytes of scratch memory held beside the cube.
    uint64_t scratch_bytes() const;
    /// How often a build had to be redone since the builder was made.
    uint32_t redone() const { return redone_; }

  private:
    struct Capacity {
        uint32_t fragments = 0, big = 0, tiles = 0, tops = 0, nodes = 0, long_lists = 0;
    };
    void allocate(Cube& cube);
    void record_scan(Commands& commands, uint32_t capacity, uint32_t counter);
    LdcParams params(const Cube& cube) const;

    Device& device_;
    Capacity capacity_;
    uint32_t triangles_ = 0, redone_ = 0;
    Buffer counters_, counters_readback_, groups_;
    Buffer node_masks_, fragments_, big_triangles_, tiles_, sums_, block_sums_, top_cells_, node_cells_, voxel_counts_;
    Buffer long_lists_, unsorted_ids_, occupancy_sums_;
};

}  // namespace peelray
