#include "bench/clock_probe.h"

#include <algorithm>
#include <chrono>

#include "base/error.h"
#include "base/interrupt.h"

namespace peelray {
namespace {

constexpr uint32_t kGroups = 1024, kSteps = 20'000;
/// A clock within this of the highest counts as it.
constexpr double kNear = 0.985;

}  // namespace

void check_timestamps(const Device& device) {
    if (device.timestamp_period() == 0)
        fail("the device '{}' has no timestamps: nothing can be measured on it; choose another ({})",
             device.info().name, setting::device);
}

ClockProbe::ClockProbe(Device& device)
    : device_(device),
      commands_(device),
      results_(device, "results of the clock probe", kGroups * 64 * 4),
      works_(!device.immediate && device.info().kind != "CPU" && device.timestamp_period() > 0) {}

double ClockProbe::time() {
    commands_.run(device_.pass("clock_probe"), {{"results", results_}}, kSteps, {kGroups});
    commands_.submit();
    const double ms = commands_.elapsed_ms();
    if (ms > 0 && (least_ms_ == 0 || ms < least_ms_)) least_ms_ = ms;
    return ms;
}

void ClockProbe::warm_up() {
    if (!works_) return;
    using Clock = std::chrono::steady_clock;
    const auto start = Clock::now();
    const auto since = [&] { return std::chrono::duration<double, std::milli>(Clock::now() - start).count(); };
    // Unknown at first, the highest clock is waited for; later no longer than that takes.
    const double patience = least_ms_ == 0 ? 600 : 1500;
    const bool known = least_ms_ > 0;
    for (int near = 0; near < 20 && since() < patience;) {
        check_interrupt();
        const double ms = time();
        if (known || since() > 400) near = ms * kNear <= least_ms_ ? near + 1 : 0;
    }
}

double ClockProbe::clock() {
    if (!works_) return 1;
    const double ms = time();
    return ms > 0 ? std::min(1.0, least_ms_ / ms) : 1;
}

}  // namespace peelray
