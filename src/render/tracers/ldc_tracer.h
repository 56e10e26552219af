// Rays in layered depth cubes.
#pragma once

#include <string>

#include "base/error.h"
#include "ldc/trace_params.h"
#include "render/tracers/ray_tracer.h"

namespace peelray {

class LdcTracer : public RayTracer {
  public:
    LdcTracer(const TracedWorld& world, const TracerChoice& choice);
    ~LdcTracer() override;

    /// Of the last build(): the next one may make others.
    const SceneCubes& cubes() const { return *cubes_; }

    bool traces() const override { return true; }
    bool counts() const override { return true; }
    const BodyTable& bodies() const override { return cubes_->cubes().table; }
    void pose(bool) override { fits_ = false; }
    void build(Commands& commands, const std::function<void()>& animate, FrameMeter& meter) override;
    void record_rebuild(Commands& commands) override;
    bool finish_rebuild(Commands& commands) override { return cubes_->finish(commands); }
    void trace(Commands& commands, const RayQueue& queue, const Buffer& hits, const TraceQuery& query) override;
    void trace_layered(Commands& commands, const LayeredRays& rays) override;
    void shadow(Commands& commands, const ShadowRays& shadows) override;
    void describe(Frame& frame) const override;
    void describe(Commands& commands, TracerStats& stats, bool bodies) const override;

  private:
    TracedScene traced() const;
    const CubeChoice& choice() const { return cubes_->choice(); }
    TraceParams params(const RayQueue& queue) const;
    /// World units; 0 of other hits.
    float tolerance() const { return choice().hit == HitTest::tolerance ? choice().tolerance : 0; }

    void make(const CubeChoice& choice);
    /// Is there nothing to build for every frame?
    bool builds_once() const { return cubes_->fixed() == bodies().bodies().size(); }
    /// Copies move to where their instances stand.
    void record_copies(Commands& commands);
    /// Uses the copies, if they are there, or not.
    void merge(bool on);
    void make_smaller(const NoRoom& error);
    void build_once(Commands& commands, const std::function<void()>& animate, FrameMeter& meter);

    Device& device_;
    const TriangleBuffers& triangles_;
    Instances& instances_;
    Assembly assembly_;  ///< its bodies, without those of copies
    const MergedInstances* const may_merge_;
    const MergedInstances* merged_;  ///< null: no copies are used
    std::vector<float> scales_;
    const CubeChoice first_choice_;
    const uint32_t fixed_bodies_;
    bool copied_ = false;  ///< the copies have been where instances stand
    std::unique_ptr<SceneCubes> cubes_;
    std::string no_room_;          ///< why `cubes_` are not of the first choice; empty: they are
    std::vector<uint32_t> shown_;  ///< instances of each body
    bool fits_ = false;            ///< this moment's cubes have been built before: it is known that they find room
    uint32_t rebuilt_ = 0;
};

}  // namespace peelray
