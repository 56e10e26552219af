// Prefix sums: scan_*.comp.
#ifndef PEELRAY_SCAN_PARAMS_H
#define PEELRAY_SCAN_PARAMS_H

#include "common/shared.h"

#ifdef __cplusplus
namespace peelray {
#endif

/// Parameters of the prefix sum passes scan_*.comp.
struct ScanParams {
    uint capacity;  ///< elements, if `counter` is SCAN_NO_COUNTER
    uint counter;   ///< which uint of the counters holds the number of elements (clamped to capacity)
};
SHARED_SIZE(ScanParams, 8);
#define SCAN_NO_COUNTER 0xffffffffu
#define SCAN_BLOCK 1024u

#ifdef __cplusplus
}  // namespace peelray
#endif
#endif
