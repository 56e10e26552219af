#include "base/interrupt.h"

#include <csignal>

namespace peelray {
namespace {

volatile std::sig_atomic_t interrupted = 0;

void remember(int number) {
    interrupted = 1;
    std::signal(number, SIG_DFL);
}

}  // namespace

void watch_interrupts() {
    for (int number : {SIGINT, SIGTERM})
        // What the parent told us to ignore (nohup, a shell's background job) stays ignored.
        if (std::signal(number, remember) == SIG_IGN) std::signal(number, SIG_IGN);
}

bool was_interrupted() {
    return interrupted != 0;
}

void check_interrupt() {
    if (interrupted) throw Interrupted("interrupted: nothing was written; run it again");
}

}  // namespace peelray
