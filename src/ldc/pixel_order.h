// The by-pixel order, which the paper's traversals read: each pixel's samples sorted by depth, and the coarse levels
// over them (docs/data.md; the paper, sections 1.2 and 1.3). Private to src/ldc.
#pragma once

#include "ldc/build_stage.h"

namespace peelray {

class PixelOrder : public BuildStage {
  public:
    void guess(BuildState& state, const BuildSize& size) override;
    void allocate(Commands& commands, BuildState& state) override;
    void clear(Commands& commands, const BuildState& state) override;
    void record(Commands& commands, const BuildState& state, const TriangleBuffers& triangles) override;
    bool grow(BuildState& state, const BuildCounts& counts) override;
    uint64_t bytes() const override;

  private:
    void record_lists(Commands& commands, const BuildState& state, const TriangleBuffers& triangles);
    void record_ranges(Commands& commands, const BuildState& state);

    Buffer pixel_counts_, slots_, sums_, block_sums_, unsorted_ids_, long_lists_;
};

}  // namespace peelray
