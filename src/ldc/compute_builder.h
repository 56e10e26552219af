// The `compute` builder: rasterises bodies into their cubes with compute shaders.
#pragma once

#include "gpu/commands.h"
#include "ldc/cubes.h"

namespace peelray {

/// Builds the cubes of a range of bodies, all at once. One builder serves many frames; its scratch memory is kept and
/// grows as needed.
///
///     do {
///         builder.record(commands, triangles);
///         commands.submit();         // with whatever else belongs to the frame
///     } while (!builder.finish(commands));  // false: something did not fit; it has room now
class ComputeBuilder {
  public:
    /// For `bodies` bodies of `cubes` (which must outlive it) from `first` on. `before`: what the tables hold of bodies
    /// that were built earlier and stay. Makes room: a guess from the bodies' bounds and numbers of triangles.
    ComputeBuilder(Device& device, Commands& commands, Cubes& cubes, uint32_t first, uint32_t bodies,
                   const TableSize& before = {});

    /// Records all passes of one build into the group "build". The bodies' bounds in `cubes` are those of their
    /// triangles now.
    void record(Commands& commands, const TriangleBuffers& triangles);

    /// After the submission: true if everything fitted. Otherwise the buffers have grown and the frame must be recorded
    /// again. Throws Error where a software device cannot sort what crowds into one voxel.
    bool finish(Commands& commands);

    /// record, submit and finish until it fits.
    void build(Commands& commands, const TriangleBuffers& triangles);

    /// Of the last finished build.
    const LdcCounters& counts() const { return counts_; }
    TableSize size() const { return {counts_.tops, counts_.occupied, counts_.nodes, counts_.fragments}; }
    /// Bytes of scratch memory held beside the cubes.
    uint64_t scratch_bytes() const;
    /// How often a build had to be redone since the builder was made.
    uint32_t redone() const { return redone_; }

  private:
    struct Capacity {
        uint32_t tops = 0, occupied = 0, nodes = 0, fragments = 0, big = 0, tiles = 0, long_lists = 0;
    };
    void guess_capacity();
    void allocate(Commands& commands);
    void record_scan(Commands& commands, uint32_t capacity, uint32_t counter);
    void record_groups(Commands& commands);
    void record_raster(Commands& commands, const TriangleBuffers& triangles);
    void record_nodes(Commands& commands);
    void record_lists(Commands& commands, const TriangleBuffers& triangles);
    void record_boxes(Commands& commands);
    LdcParams params() const;

    Device& device_;
    Cubes& cubes_;
    uint32_t first_, bodies_;
    TableSize before_;
    Capacity capacity_;
    LdcCounters counts_{};
    uint32_t redone_ = 0;
    Buffer counters_, counters_readback_, groups_;
    Buffer node_masks_, fragments_, big_triangles_, tiles_, sums_, block_sums_, top_cells_, node_cells_, voxel_counts_;
    Buffer long_lists_, unsorted_ids_, occupancy_sums_;
};

}  // namespace peelray
