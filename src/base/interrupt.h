// Ctrl-C during long work: it ends at the next convenient place, tidied up and with one line.
#pragma once

#include "base/error.h"

namespace peelray {

/// A signal ended the work. Who knows what was finished by then may say so in its place.
class Interrupted : public Error {
  public:
    using Error::Error;
};

/// From now on the first SIGINT or SIGTERM is remembered instead of ending the process; a second one ends it at once.
void watch_interrupts();

/// Did a signal come since watch_interrupts()?
bool was_interrupted();

/// Throws Interrupted if a signal came since watch_interrupts(). Long work calls it between its steps.
void check_interrupt();

}  // namespace peelray
