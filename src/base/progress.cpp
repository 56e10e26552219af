#include "base/progress.h"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace peelray {

using Clock = std::chrono::steady_clock;

/// "9 s", "12 min", "3 h 20 min": as exact as a guess deserves.
static std::string duration(double seconds) {
    if (seconds < 120) return fmt::format("{:.0f} s", seconds);
    const int minutes = static_cast<int>(std::min(seconds / 60, 1e8));
    return minutes < 120 ? fmt::format("{} min", minutes) : fmt::format("{} h {} min", minutes / 60, minutes % 60);
}

Progress::Progress(std::string label, double total, std::string unit)
    : label_(std::move(label)),
      unit_(std::move(unit)),
      total_(total),
      terminal_(isatty(STDERR_FILENO)),
      start_(Clock::now()),
      last_(start_) {}

Progress::~Progress() {
    if (drawn_) fmt::print(stderr, "\r\033[K");
}

void Progress::update(double done) {
    if (!terminal_ || total_ <= 0) return;
    const auto now = Clock::now();
    if (now - start_ < std::chrono::milliseconds(500) || now - last_ < std::chrono::milliseconds(50)) return;
    last_ = now;
    drawn_ = true;
    const double share = std::clamp(done / total_, 0.0, 1.0);
    const double elapsed = std::chrono::duration<double>(now - start_).count();
    const int filled = static_cast<int>(share * 30);
    const double left = share > 0 ? elapsed * (1 - share) / share : 0;
    const std::string state = unit_.empty() ? fmt::format("{:.0f} %", share * 100)
                                            : fmt::format("{:.0f}/{:.0f} {}, {:.3g} {}/s", std::floor(done), total_,
                                                          unit_, done / elapsed, unit_);
    fmt::print(stderr, "\r\033[K{} [{}{}] {}, {} left", label_, std::string(filled, '#'), std::string(30 - filled, ' '),
               state, duration(left));
    std::fflush(stderr);
}

}  // namespace peelray
