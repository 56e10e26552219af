// The device's own ray tracing.
#pragma once

#include "render/tracers/ray_tracer.h"

namespace peelray {

class KhrTracer : public RayTracer {
  public:
    KhrTracer(const TracedWorld& world, const TracerChoice& choice);

    bool traces() const override { return true; }
    const BodyTable& bodies() const override { return bodies_; }
    void pose(bool moved) override;
    void build(Commands& commands, const std::function<void()>& animate, FrameMeter& meter) override;
    void record_rebuild(Commands& commands) override { structures_.record(commands, true); }
    void trace(Commands& commands, const RayQueue& queue, const Buffer& hits, const TraceQuery& query) override;
    void trace_layered(Commands& commands, const LayeredRays& rays) override;
    void shadow(Commands& commands, const ShadowRays& shadows) override;
    void describe(Commands& commands, TracerStats& stats, bool bodies) const override;

  private:
    /// What shading reads, and the triangles themselves; of it what a pass uses.
    std::vector<Binding> with_surfaces(const std::vector<Binding>& surfaces) const;

    Device& device_;
    const TriangleBuffers& triangles_;
    Instances& instances_;
    StructureUpdate update_;
    Structures structures_;
    BodyTable bodies_;
    /// Instances stand elsewhere than where they stood before the last moment that was built.
    bool moved_ = false;
    bool built_ = false;  ///< at this moment
};

}  // namespace peelray
