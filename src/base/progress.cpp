#include "base/progress.h"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace peelray {

using Clock = std::chrono::steady_clock;

Progress::Progress(std::string label, double total)
    : label_(std::move(label)), total_(total), terminal_(isatty(STDERR_FILENO)), start_(Clock::now()), last_(start_) {}

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
    fmt::print(stderr, "\r\033[K{} [{}{}] {:.0f} %, {:.0f} s left", label_, std::string(filled, '#'),
               std::string(30 - filled, ' '), share * 100, left);
    std::fflush(stderr);
}

}  // namespace peelray
