// The by-voxel order, which the `voxel` traversal reads (docs/data.md). Private to src/ldc.
#pragma once

#include "ldc/build_stage.h"

namespace peelray {

class VoxelOrder : public BuildStage {
  public:
    void guess(BuildState& state, const BuildSize& size) override;
    void allocate(Commands& commands, BuildState& state) override;
    void clear(Commands& commands, const BuildState& state) override;
    void record(Commands& commands, const BuildState& state, const TriangleBuffers& triangles) override;
    void read(const BuildState& state, BuildCounts& counts) const override;
    bool grow(BuildState& state, const BuildCounts& counts) override;
    void settle(BuildState& state, const BuildCounts& counts) override;
    uint64_t bytes() const override;

  private:
    void record_tops(Commands& commands, const BuildState& state);
    void record_nodes(Commands& commands, const BuildState& state);
    void record_refinement(Commands& commands, const BuildState& state);
    void record_sums(Commands& commands, const BuildState& state, uint32_t axis);

    Buffer top_cells_, node_cells_, voxel_counts_, occupancy_sums_;
    Buffer refine_queue_, refined_, refined_readback_;  ///< the latter: LdcRefined
};

}  // namespace peelray
