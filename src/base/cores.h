// The processor cores that this process may use.
#pragma once

#include <cstddef>

namespace peelray {

/// At least 1; what `taskset` and containers leave of the machine's.
size_t usable_cores();

/// Bytes that the machine has; 0: unknown.
size_t machine_memory();

}  // namespace peelray
