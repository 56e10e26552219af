// A progress bar for long work: on a terminal only, so that logs and pipes stay clean.
#pragma once

#include <chrono>
#include <string>

namespace peelray {

/// Draws "label [#####     ] 42 %, 3 s left" on standard error while work goes on; nothing if that is not a terminal,
/// or if the work is done within half a second. With a unit it counts: "label [##   ] 12/40 frames, 3.1 frames/s, 9 s
/// left".
class Progress {
  public:
    Progress(std::string label, double total, std::string unit = "");
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// Reports that `done` of `total` units are finished.
    void update(double done);

  private:
    std::string label_, unit_;
    double total_;
    bool terminal_;
    bool drawn_ = false;
    std::chrono::steady_clock::time_point start_, last_;
};

}  // namespace peelray
