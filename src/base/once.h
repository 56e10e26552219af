// What is made when it is first asked for, by any thread.
#pragma once

#include <atomic>
#include <mutex>

namespace peelray {

/// As std::once_flag, but where it has been made already only a load: std::call_once() takes longer than a lookup in a
/// table.
class Once {
  public:
    template <typename Make>
    void operator()(Make make) {
        if (made_.load(std::memory_order_acquire)) return;
        std::call_once(flag_, [&] {
            make();
            made_.store(true, std::memory_order_release);
        });
    }

  private:
    std::once_flag flag_;
    std::atomic<bool> made_ = false;
};

}  // namespace peelray
