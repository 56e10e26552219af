// Which triangle each pixel of the picture sees, by compute shaders: they run on all of a GPU, graphics shaders on some
// GPUs only on a small part.
#pragma once

#include "render/view_passes.h"

namespace peelray {

class ComputeView {
  public:
    explicit ComputeView(Device& device) : device_(device) {}

    /// Can it do this scene? Not without 64-bit atomics in buffers, nor for more than 2^31 drawn triangles.
    static bool possible(const Device& device, const GpuScene& scene);
    /// Is it the faster way? Software devices rasterise triangles faster than they run shaders that do: 1.5 times with
    /// Mesa's on 56,000 triangles, seventy times where materials are masked.
    static bool preferable(const Device& device, const GpuScene& scene) {
        return possible(device, scene) && device.info().kind != "CPU";
    }

    /// Finds the triangles for rays through `jitter` of each pixel, [0, 1)²: what `target.visibility` then holds are
    /// the numbers of drawn triangles (shaders/view/seen.glsl). Counts in the queues' counters, which must be clear.
    void record(Commands& commands, const GpuScene& scene, const ViewTarget& target, const PathQueues& queues,
                const glm::vec2& jitter);

    /// After the submission: true if the queue of blocks was large enough, else it has grown. Throws Error where the
    /// device does not bind as much.
    bool finish(const PathQueues& queues);

    uint64_t bytes() const { return blocks_.bytes(); }

  private:
    Device& device_;
    uint32_t capacity_ = 0;  ///< blocks
    Buffer blocks_;          ///< drawn triangle and first tile of each block
};

}  // namespace peelray
