// A progress bar for long work: on a terminal only, so that logs and pipes stay clean.
#pragma once

#include <chrono>
#include <string>

namespace peelray {

/// Draws "label [#####     ] 42 %, 3 s left" on standard error while work goes on; nothing if that is no terminal,
/// or if the work is done within half a second.
class Progress {
  public:
    Progress(std::string label, double total);
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// Reports that `done` of `total` units are finished.
    void update(double done);

  private:
    std::string label_;
    double total_;
    bool terminal_;
    bool drawn_ = false;
    std::chrono::steady_clock::time_point start_, last_;
};

}  // namespace peelray
