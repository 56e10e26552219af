#include "render/cost_counter.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "base/error.h"

namespace peelray {

uint32_t KindCosts::percentile(size_t field, double share) const {
    const auto wanted = uint64_t(std::ceil(share * double(rays)));
    uint64_t below = 0;
    for (uint32_t i = 0; i < COUNT_BUCKETS && !buckets.empty(); i++) {
        below += buckets[field * COUNT_BUCKETS + i];
        if (below < wanted) continue;
        // The most that a ray of the bucket costs.
        const uint32_t power = (i - COUNT_EQUAL) / 32 + 3, most = ((32 + (i - COUNT_EQUAL) % 32 + 1) << power) - 1;
        return std::min(i < COUNT_EQUAL ? i : most, largest.*kRayCostFields[field].value);
    }
    return 0;
}

CostTotals::CostTotals(Device& device)
    : totals_(device, "costs of rays by kind", COUNT_KINDS * sizeof(CountTotals)),
      readback_(device, "costs of rays by kind readback", COUNT_KINDS * sizeof(CountTotals), Buffer::Where::readback) {}

void CostTotals::record_readback(Commands& commands) const {
    commands.copy(totals_, readback_, COUNT_KINDS * sizeof(CountTotals));
}

void CostTotals::add_to(AllKindCosts& sums) const {
    for (size_t kind = 0; kind < COUNT_KINDS; kind++) {
        CountTotals counted;
        std::memcpy(&counted, readback_.mapped() + kind * sizeof counted, sizeof counted);
        const auto low = std::bit_cast<RayCosts>(counted.low), high = std::bit_cast<RayCosts>(counted.high),
                   largest = std::bit_cast<RayCosts>(counted.largest);
        KindCosts& sum = sums[kind];
        sum.rays += counted.rays;
        for (size_t i = 0; i < kRayCostFields.size(); i++) {
            const auto value = kRayCostFields[i].value;
            sum.sums[i] += uint64_t(high.*value) << 32 | low.*value;
            sum.largest.*value = std::max(sum.largest.*value, largest.*value);
        }
        sum.buckets.resize(COUNT_FIELDS * COUNT_BUCKETS);
        for (size_t i = 0; i < sum.buckets.size(); i++) sum.buckets[i] += counted.buckets[i];
    }
}

void CostCounter::record_begin(Commands& commands, uint64_t pixels) {
    ensure_size(device_, pixel_costs_, "costs of pixels", pixels * sizeof(RayCosts));
    commands.fill(pixel_costs_, 0);
    sums_ = {};
}

void CostCounter::record_band(Commands& commands, PathQueues& queues, uint32_t levels) {
    totals_.record_clear(commands);
    costs_.resize(std::max<size_t>(costs_.size(), levels));
    ensure_size(device_, light_costs_, "costs of shadow rays", uint64_t(queues.lights().capacity) * sizeof(RayCosts));
    commands.fill(light_costs_, 0);
    for (uint32_t i = 0; i < levels; i++) {
        ensure_size(device_, costs_[i], fmt::format("costs of bounce {}", i),
                    uint64_t(queues.level(i).capacity) * sizeof(RayCosts));
        commands.fill(costs_[i], 0);
    }
}

void CostCounter::record_sums(Commands& commands, PathQueues& queues, const Buffer& frame,
                              const std::vector<LevelParams>& params) const {
    for (size_t i = params.size(); i-- > 0;) {
        const PathLevel& level = queues.level(uint32_t(i));
        const std::vector<Binding> bindings = {
            {"costs", costs_[i]},
            Binding::if_used("next_costs", i + 1 < params.size() ? &costs_[i + 1] : nullptr),
            {"light_costs", light_costs_},
            {"nodes", level.nodes},
            {"branches", level.branches},
            {"queue", queues.counters()},
            {"frame", frame}};
        commands.run(device_.pass("gather_costs"), bindings, params[i], groups_for(params[i].capacity, 64));
    }
    commands.run(device_.pass("accumulate_costs"),
                 {{"frame", frame}, {"costs", costs_[0]}, {"queue", queues.counters()}, {"pixel_costs", pixel_costs_}},
                 params[0], groups_for(params[0].capacity, 64));
    totals_.record_readback(commands);
}

}  // namespace peelray
