// The `peel` builder's rasteriser: depth peeling, one pass per layer, as in the paper's section 1.2. Private to
// src/ldc.
#pragma once

#include "ldc/graphics_raster.h"

namespace peelray {

/// Bodies are peeled one after the other into the same targets, three layers of two colours: normal and depth; base
/// colour and triangle id. The depth complexity is counted first. Enough passes must be recorded for it: as many as
/// there were layers last time, and some more, which draw nothing if they are not needed.
class PeelRasterizer : public BuildStage {
  public:
    PeelRasterizer(Device& device, const Cubes& cubes);
    void guess(BuildState& state, const BuildSize& size) override;
    void allocate(Commands& commands, BuildState& state) override;
    void record(Commands& commands, const BuildState& state, const TriangleBuffers& triangles) override;
    bool grow(BuildState& state, const BuildCounts& counts) override;
    uint64_t bytes() const override;

  private:
    void record_body(Commands& commands, const BuildState& state, const TriangleBuffers& triangles, uint32_t index);
    uint32_t record_complexity(Commands& commands, const BuildState& state, const TriangleBuffers& triangles,
                               const LdcParams& params);

    RoutedSetup counting_, peeling_;
    bool apart_;                    ///< the LDIs are drawn one by one
    uint32_t side_ = 0;             ///< pixels along a side of the largest LDI
    std::vector<uint32_t> passes_;  ///< recorded for each body of the build
    Image2D depth_maps_[2], id_maps_[2], depth_;
    Buffer layer_counts_, complexities_, complexities_readback_, draws_, groups_;
};

}  // namespace peelray
