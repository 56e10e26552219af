// A scene for rays alone: cubes, or acceleration structures, and what tells whose triangles were hit, nothing to shade
// with but what tells which hits count.
#pragma once

#include "render/tracers/ray_tracer.h"

namespace peelray {

class RayScene {
  public:
    /// Uploads the scene at a moment, which is that of its assembly, and builds what the tracer needs. Throws Error
    /// where the device has no acceleration structures for Tracer::khr.
    RayScene(Device& device, const Scene& scene, const Moment& moment, const Assembly& assembly,
             const TracerChoice& choice);
    RayScene(const RayScene&) = delete;
    RayScene& operator=(const RayScene&) = delete;

    /// Records the tracing of `count` rays (Ray each): file_hits[i] (FileHit each) for rays[i], see record_trace.
    /// `counting`: where it is counted what they cost, if that is not null.
    void record(Commands& commands, const Buffer& rays, uint32_t count, const Buffer& file_hits, bool any_hit,
                const CountBuffers* counting = nullptr);

    /// The same in two parts: hits[i] (Hit each) for the rays of a queue, and their translation.
    void record_hits(Commands& commands, const RayQueue& queue, const Buffer& hits, bool any_hit, Edges edges);
    void record_translation(Commands& commands, const Buffer& hits, uint32_t count, const Buffer& file_hits);

    /// Of what is built for every frame, and where it stands: see RayTracer.
    void record_build(Commands& commands) { tracer_->record_rebuild(commands); }
    bool finish_build(Commands& commands) { return tracer_->finish_rebuild(commands); }

    const RayTracer& tracer() const { return *tracer_; }
    TracerStats stats(Commands& commands) const;
    const Instances& instances() const { return instances_; }
    /// What the first build took.
    const FrameMeter& build() const { return build_; }

  private:
    Device& device_;
    TriangleBuffers triangles_;
    BaseColorBuffers base_colors_;  ///< only where a material is masked or single-sided
    Buffer triangle_ids_, hits_;
    Instances instances_;
    std::unique_ptr<MergedInstances> merged_;
    std::unique_ptr<RayTracer> tracer_;
    FrameMeter build_;
};

}  // namespace peelray
