// A GPU that was idle lowers its clock, and takes a while to raise it: what is measured then is the clock. The host
// cannot read it, but it can time work of a fixed number of cycles.
#pragma once

#include "gpu/commands.h"

namespace peelray {

/// Throws Error if the device has no timestamps.
void check_timestamps(const Device& device);

class ClockProbe {
  public:
    explicit ClockProbe(Device& device);

    /// Keeps the device busy until its clock is as high as it has been, or rises no more. Software devices have none.
    void warm_up();
    /// The clock now by the highest seen so far, at most 1; 1 where it cannot be known.
    double clock();

  private:
    double time();

    Device& device_;
    Commands commands_;
    Buffer results_;
    bool works_;
    double least_ms_ = 0;
};

}  // namespace peelray
