// A loop on all cores.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <system_error>
#include <thread>
#include <vector>

namespace peelray {

/// Calls `work(i)` once for every i in [0, count), `grain` neighbours at a time, on all cores and in no order. `work`
/// must not throw.
template <typename Work>
void parallel_for(size_t count, size_t grain, Work work) {
    std::atomic<size_t> next{0};
    const auto take = [&] {
        for (size_t first; (first = next.fetch_add(grain)) < count;)
            for (size_t i = first; i < std::min(first + grain, count); ++i) work(i);
    };
    const size_t useful = std::min<size_t>((count + grain - 1) / grain, std::thread::hardware_concurrency());
    std::vector<std::thread> others;
    try {
        while (others.size() + 1 < useful) others.emplace_back(take);
    } catch (const std::system_error&) {
        // No more threads can be started: those that run do the work.
    }
    take();
    for (std::thread& other : others) other.join();
}

}  // namespace peelray
