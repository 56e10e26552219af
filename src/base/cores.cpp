#include "base/cores.h"

#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <thread>

namespace peelray {

size_t usable_cores() {
    cpu_set_t set;
    CPU_ZERO(&set);
    // Fails on machines with more cores than the set has room for.
    if (::sched_getaffinity(0, sizeof set, &set) == 0) return size_t(std::max(CPU_COUNT(&set), 1));
    return std::max(std::thread::hardware_concurrency(), 1u);
}

size_t machine_memory() {
    const long pages = ::sysconf(_SC_PHYS_PAGES), bytes = ::sysconf(_SC_PAGE_SIZE);
    return pages > 0 && bytes > 0 ? size_t(pages) * size_t(bytes) : 0;
}

}  // namespace peelray
