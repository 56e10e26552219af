// The device's own ray tracing in a benchmark.
#pragma once

#include "bench/gpu_contender.h"
#include "render/ray_scene.h"

namespace peelray {

class KhrContender : public GpuContender {
  public:
    /// The scene at a moment, which is that of its assembly. `update`: how its structures are built, and whether they
    /// are at all once they stand (StructureUpdate::keep). Throws Error where the device has no ray tracing or the
    /// scene does not fit it.
    KhrContender(Device& device, ClockProbe& probe, const Scene& scene, const Moment& moment, const Assembly& assembly,
                 StructureUpdate update);

    Claim claim() const override { return Claim::single; }
    Timing time_build(uint32_t runs) override;
    Timing time_refit(uint32_t runs) override;
    MemoryUse memory() const override;

  protected:
    void record_build(Commands& commands) override { scene_->record_build(commands); }
    bool finish_build(Commands&) override { return true; }
    void record_hits(Commands& commands, const RayQueue& queue, const Buffer& hits, bool any_hit) override {
        scene_->record_hits(commands, queue, hits, any_hit, Edges::single);
    }
    void record_translation(Commands& commands, const Buffer& hits, uint32_t count, const Buffer& file_hits) override {
        scene_->record_translation(commands, hits, count, file_hits);
    }

  private:
    const Scene& source_;
    const Moment& moment_;
    const Assembly& assembly_;
    StructureUpdate update_;
    std::unique_ptr<RayScene> scene_;
};

}  // namespace peelray
