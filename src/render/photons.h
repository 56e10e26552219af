// Photons for caustics: sent from the lamps, traced through the queues of rays that the tracer takes, kept where they
// come to rest on what scatters light, and gathered around the hits of the tree of rays (docs/frame.md section 5).
#pragma once

#include "gpu/buffer.h"
#include "path/path_params.h"
#include "scene/photons.h"

namespace peelray {

struct FrameState;

class PhotonMap {
  public:
    explicit PhotonMap(Device& device) : device_(device) {}

    /// Makes room for a picture's photons. Throws Error where the device cannot bind as many. Submits.
    void prepare(FrameState& f, PhotonPlan plan);

    /// Records all of one sample: sending, tracing, sorting. Needs cleared counters.
    void record(FrameState& f, uint32_t sample);

    /// Records what the photons add to the nodes of a level.
    void record_gather(FrameState& f, const LevelParams& level);

    const PhotonPlan& plan() const { return plan_; }
    uint64_t bytes() const;

  private:
    void record_flight(FrameState& f, const PhotonPass& pass);
    void record_trace(FrameState& f);
    void record_scatter(FrameState& f, const PhotonPass& pass, uint32_t level, bool last);
    void record_grid(FrameState& f);
    PhotonGridParams grid() const;

    Device& device_;
    PhotonPlan plan_;
    float radius_ = 0;  ///< of the sample that was recorded last
    uint32_t buckets_ = 0;
    Buffer lamps_, targets_, thresholds_;
    Buffer rays_, skip_, hits_, states_, media_, walls_;  ///< an entry each for a photon; media only where they overlap
    Buffer photons_, sorted_;
    Buffer sums_, block_sums_;  ///< of the buckets of the grid
};

}  // namespace peelray
