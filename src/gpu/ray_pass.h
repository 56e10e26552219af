// A ray tracing pass: its shaders, one pipeline, one shader binding table.
#pragma once

#include "gpu/buffer.h"
#include "gpu/pass.h"

namespace peelray {

/// How a ray tracing pass is put together: every ray has the same shaders.
struct RaySetup {
    std::string rays;          ///< name of the shaders of misses and hits; empty: the pass's own
    bool nearest = true;       ///< RAYS.rchit is called for the nearest hit
    bool any = false;          ///< RAYS.rahit is called for hits on what is not opaque
    Constants constants = {};  ///< of all stages

    auto operator<=>(const RaySetup&) const = default;
};

/// A ray tracing pass (see Commands::trace): NAME.rgen starts the rays, RAYS.rmiss is called for misses; the first miss
/// shader and the first hit group are all there are. Shaders of hits start no rays.
class RayPass : public PassBase {
  public:
    RayPass(Device& device, VkPipelineCache cache, std::string_view shader, const RaySetup& setup);

    /// The shader binding table: of ray generation, misses and hits.
    const VkStridedDeviceAddressRegionKHR& generation() const { return regions_[0]; }
    const VkStridedDeviceAddressRegionKHR& misses() const { return regions_[1]; }
    const VkStridedDeviceAddressRegionKHR& hits() const { return regions_[2]; }

  private:
    void create_table();

    Buffer table_;
    VkStridedDeviceAddressRegionKHR regions_[3] = {};
};

}  // namespace peelray
