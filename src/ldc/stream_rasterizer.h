// The a-buffer of drawn streams. Private to src/ldc.
#pragma once

#include "ldc/graphics_raster.h"

namespace peelray {

class StreamRasterizer : public BuildStage {
  public:
    StreamRasterizer(Device& device, const Cubes& cubes);
    void guess(BuildState& state, const BuildSize& size) override;
    void allocate(Commands& commands, BuildState& state) override;
    void record(Commands& commands, const BuildState& state, const TriangleBuffers& triangles) override;
    bool grow(BuildState&, const BuildCounts&) override { return false; }
    uint64_t bytes() const override { return 0; }

  private:
    uint32_t side_ = 0;
};

}  // namespace peelray
