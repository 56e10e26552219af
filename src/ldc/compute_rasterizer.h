// The `compute` builder's rasteriser: small triangles one thread each, large ones in blocks. Private to src/ldc.
#pragma once

#include "ldc/build_stage.h"

namespace peelray {

class ComputeRasterizer : public BuildStage {
  public:
    void guess(BuildState& state, const BuildSize& size) override;
    void allocate(Commands& commands, BuildState& state) override;
    void record(Commands& commands, const BuildState& state, const TriangleBuffers& triangles) override;
    bool grow(BuildState& state, const BuildCounts& counts) override;
    void settle(BuildState& state, const BuildCounts& counts) override;
    uint64_t bytes() const override { return blocks_.bytes(); }

  private:
    Buffer blocks_;
};

}  // namespace peelray
