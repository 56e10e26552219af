// What repeated measurements amount to.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

namespace peelray {

/// Milliseconds of one thing, measured several times.
struct Timing {
    uint32_t runs = 0;  ///< 0: not measured
    double median = 0, least = 0, most = 0;
    /// The last time by the first one. No program can read the clocks of all devices: where they changed meanwhile,
    /// this is not 1.
    double drift = 1;
    /// The device's clock afterwards by the highest seen so far (ClockProbe); 1 where it cannot be known.
    double clock = 1;
};

/// `ms`: in the order of measurement; of none: no runs.
Timing timing_of(std::vector<double> ms);

/// Times `run` (milliseconds each) `runs` times, after at least two that warm up and last 20 ms together. Throws what
/// it throws, and Interrupted between its runs.
Timing time_repeatedly(uint32_t runs, const std::function<double()>& run);

}  // namespace peelray
