// The `abuffer` builder's rasteriser: one pass through the graphics pipeline, without targets; fragments append
// themselves (what the paper expects of future devices at the end of its section 1.2.1). Private to src/ldc.
#pragma once

#include "ldc/graphics_raster.h"

namespace peelray {

class AbufferRasterizer : public BuildStage {
  public:
    AbufferRasterizer(Device& device, const Cubes& cubes);
    void guess(BuildState& state, const BuildSize& size) override;
    void allocate(Commands&, BuildState&) override {}
    void record(Commands& commands, const BuildState& state, const TriangleBuffers& triangles) override;
    bool grow(BuildState&, const BuildCounts&) override { return false; }
    uint64_t bytes() const override { return 0; }

  private:
    RoutedSetup routed_;
    uint32_t side_ = 0;  ///< pixels along a side of the largest LDI
};

}  // namespace peelray
