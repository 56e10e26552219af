// Nobody traces: no ray hits anything, and no light is blocked.
#pragma once

#include "render/tracers/ray_tracer.h"

namespace peelray {

/// The bodies of an assembly where no cubes are built.
BodyTable plain_bodies(Device& device, const Assembly& assembly);

class NoTracer : public RayTracer {
  public:
    explicit NoTracer(const TracedWorld& world)
        : instances_(world.instances), bodies_(plain_bodies(world.device, world.assembly)) {}

    bool traces() const override { return false; }
    const BodyTable& bodies() const override { return bodies_; }
    void pose(bool) override {}
    void build(Commands& commands, const std::function<void()>& animate, FrameMeter&) override {
        animate();
        record_rebuild(commands);
    }
    void record_rebuild(Commands& commands) override { instances_.record(commands, bodies_, false); }
    void trace(Commands& commands, const RayQueue&, const Buffer& hits, const TraceQuery&) override {
        commands.fill(hits, ~0u);
    }
    void trace_layered(Commands&, const LayeredRays&) override {}  // without a tracer none are made
    void shadow(Commands&, const ShadowRays&) override {}

  private:
    Instances& instances_;
    BodyTable bodies_;
};

}  // namespace peelray
