#include "ldc/build_stage.h"
#include "common/scan_params.h"

#include <algorithm>

namespace peelray {

void BuildState::record_groups(Commands& commands) const {
    commands.run(device.pass("ldc_groups"), {{"counters", counters}, {"groups", groups}}, params, {1});
}

uint32_t bounded(const BuildState& state, uint64_t count, uint64_t bytes_each) {
    return uint32_t(std::min(count, state.most() / bytes_each));
}

void settle_capacity(uint32_t& capacity, uint32_t needed) {
    capacity = uint32_t(std::min<uint64_t>(capacity, uint64_t(needed) * 9 / 8 + 64));
}

bool grow_capacity(uint32_t& capacity, uint32_t needed, uint64_t most) {
    if (needed <= capacity) return false;
    // The reserve is optional, the need is not: what exceeds the device's limit fails where memory is allocated.
    const uint64_t reserve = std::min<uint64_t>(uint64_t(needed) * 3 / 2 + 64, 0x7fffffffu);
    capacity = uint32_t(std::max<uint64_t>(needed, std::min(reserve, most)));
    return true;
}

void record_scan(Commands& commands, const BuildState& state, uint32_t capacity, uint32_t counter, const Buffer& sums,
                 const Buffer& block_sums) {
    const ScanParams p{capacity, counter};
    const Groups groups = groups_for(capacity, SCAN_BLOCK);
    commands.run(state.device.pass("scan_reduce"),
                 {{"counters", state.counters}, {"sums", sums}, {"block_sums", block_sums}}, p, groups);
    commands.run(state.device.pass("scan_blocks"), {{"block_sums", block_sums}}, p, {1});
    commands.run(state.device.pass("scan_apply"),
                 {{"counters", state.counters}, {"sums", sums}, {"block_sums", block_sums}}, p, groups);
}

}  // namespace peelray
