#include "bench/timing.h"

#include <algorithm>
#include <chrono>

#include "base/interrupt.h"

namespace peelray {

Timing timing_of(std::vector<double> ms) {
    Timing timing;
    if (ms.empty()) return timing;
    timing.runs = uint32_t(ms.size());
    timing.drift = ms.front() > 0 ? ms.back() / ms.front() : 1;
    std::sort(ms.begin(), ms.end());
    timing.median = ms[ms.size() / 2];
    timing.least = ms.front();
    timing.most = ms.back();
    return timing;
}

Timing time_repeatedly(uint32_t runs, const std::function<double()>& run) {
    using Clock = std::chrono::steady_clock;
    constexpr uint32_t least = 2, most = 100;
    const auto enough = Clock::now() + std::chrono::milliseconds(20);
    for (uint32_t i = 0; i < least || (i < most && Clock::now() < enough); i++) {
        check_interrupt();
        run();
    }
    std::vector<double> ms;
    for (uint32_t i = 0; i < runs; i++) {
        check_interrupt();
        ms.push_back(run());
    }
    return timing_of(std::move(ms));
}

}  // namespace peelray
