// What the picture's camera sees: which triangle is at each pixel, by compute shaders or by the rasteriser.
#pragma once

#include "render/compute_view.h"
#include "render/render_settings.h"

namespace peelray {

class CameraView {
  public:
    explicit CameraView(Device& device) : target(device), device_(device), compute_(device) {}

    /// Chooses the way and makes room.
    void prepare(const GpuScene& scene, const RenderSettings& settings);
    /// Records what a sample of all pixels sees. Counts in the queues' counters, which must be clear.
    void record(Commands& commands, const GpuScene& scene, const PathQueues& queues, uint32_t sample);
    /// After the submission: false if it must be recorded again, with more room.
    bool finish(const PathQueues& queues) { return !by_compute_ || compute_.finish(queues); }

    /// The numbers of drawn triangles are in target.visibility, not those of triangles and instances.
    bool by_number() const { return by_compute_; }
    uint64_t bytes() const { return target.visibility.bytes() + compute_.bytes(); }

    ViewTarget target;

  private:
    Device& device_;
    ComputeView compute_;
    bool by_compute_ = false;
};

}  // namespace peelray
