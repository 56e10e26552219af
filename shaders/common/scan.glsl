// Shared by the scan_* passes: the number of elements, known on the host or counted on the GPU.
#include "common/scan_params.h"
uint scanCount() { return params.counter == SCAN_NO_COUNTER ? params.capacity : min(params.capacity, counters[params.counter]); }
