// A contender on the device: passes are recorded, timed by the device and their hits downloaded.
#pragma once

#include "bench/clock_probe.h"
#include "bench/contender.h"
#include "ldc/tracer.h"

namespace peelray {

class GpuContender : public RayContender {
  public:
    Timing time_build(uint32_t runs) override;
    void take(std::vector<Ray> rays) override;
    Timing time_trace(bool any_hit, uint32_t runs) override;
    std::vector<FileHit> answers() override;

  protected:
    /// Both must outlive it.
    GpuContender(Device& device, ClockProbe& probe);

    virtual void record_build(Commands& commands) = 0;
    /// After the submission: false if something did not fit; then it is recorded again.
    virtual bool finish_build(Commands& commands) = 0;
    /// hits[i] (Hit each) for the rays of the queue, as record_trace() has it.
    virtual void record_hits(Commands& commands, const RayQueue& queue, const Buffer& hits, bool any_hit) = 0;
    /// Of the hits (Hit each): FileHit each.
    virtual void record_translation(Commands& commands, const Buffer& hits, uint32_t count,
                                    const Buffer& file_hits) = 0;
    Timing time_submissions(uint32_t runs, const std::function<void()>& record, const std::function<bool()>& finish);

    Device& device_;
    ClockProbe& probe_;
    Commands commands_;

    /// Traces all rays once more and counts what they cost.
    KindCosts count_costs(bool any_hit);

  private:
    /// As many rays as the device binds at once.
    struct Batch {
        Buffer rays, hits;
        uint32_t count = 0;
    };
    std::vector<Batch> batches_;
};

}  // namespace peelray
