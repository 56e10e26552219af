// Counts what rays cost: of each hit of the tree of rays, of each pixel, and of each kind of ray in all.
#pragma once

#include <array>
#include <vector>

#include "base/ray_costs.h"
#include "gpu/commands.h"
#include "ldc/trace_params.h"
#include "ldc/tracer.h"
#include "render/path_queues.h"

namespace peelray {

/// What the rays of one kind cost.
struct KindCosts {
    uint64_t rays = 0;
    std::array<uint64_t, kRayCostFields.size()> sums{};  ///< in the order of kRayCostFields
    RayCosts largest;                                    ///< of a single ray
    std::vector<uint64_t> buckets;                       ///< as CountTotals has them; empty: no rays

    double mean(size_t field) const { return rays ? double(sums[field]) / double(rays) : 0; }
    /// What at least `share` of the rays, above 0, cost at most; from COUNT_EQUAL on up to 3 % too much.
    uint32_t percentile(size_t field, double share) const;
};

/// By kind, COUNT_TRACED, ...
using AllKindCosts = std::array<KindCosts, COUNT_KINDS>;

/// The totals on the device, and their way back.
class CostTotals {
  public:
    explicit CostTotals(Device& device);

    const Buffer& buffer() const { return totals_; }
    void record_clear(Commands& commands) const { commands.fill(totals_, 0); }
    void record_readback(Commands& commands) const;
    /// Adds what the last submission counted to `sums`.
    void add_to(AllKindCosts& sums) const;

  private:
    Buffer totals_, readback_;
};

/// Of a picture's rays. A band that does not fit is counted when it is done again.
class CostCounter {
  public:
    explicit CostCounter(Device& device) : device_(device), totals_(device) {}

    /// Before a picture's first band.
    void record_begin(Commands& commands, uint64_t pixels);
    /// Before a band: room for what the queues have room for, cleared.
    void record_band(Commands& commands, PathQueues& queues, uint32_t levels);
    CountBuffers level(uint32_t index) const { return {costs_[index], totals_.buffer()}; }
    /// Of the queue of shadow rays.
    CountBuffers lights() const { return {light_costs_, totals_.buffer()}; }
    /// After a band: its costs from the deepest level up to its pixels. `params`: of each level.
    void record_sums(Commands& commands, PathQueues& queues, const Buffer& frame,
                     const std::vector<LevelParams>& params) const;
    /// After the submission of a band that fitted.
    void finish() { totals_.add_to(sums_); }

    const AllKindCosts& sums() const { return sums_; }
    std::vector<RayCosts> download_pixels(Commands& commands, uint64_t pixels) const {
        return commands.download<RayCosts>(pixel_costs_, pixels);
    }

  private:
    Device& device_;
    CostTotals totals_;
    std::vector<Buffer> costs_;  ///< of a level's entries
    Buffer light_costs_;         ///< of the shadow rays
    Buffer pixel_costs_;
    AllKindCosts sums_;
};

}  // namespace peelray
