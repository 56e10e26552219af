// Work for other threads while the one that gives it goes on, with a bound on what waits.
//
//     WorkerPool pool({.threads = usable_cores(), .items = 32, .bytes = 1 << 30});
//     for (...) {
//         Picture picture = render();  // meanwhile others are encoded
//         pool.add(bytes_of(picture), [picture = std::move(picture)] { ... });
//     }
//     pool.finish();
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

namespace peelray {

class WorkerPool {
  public:
    struct Limits {
        size_t threads = 1;           ///< at least 1; they are started as there is work for them
        size_t items = 2;             ///< at least 1: given, and not finished
        uint64_t bytes = UINT64_MAX;  ///< that these hold; an item that holds more is taken where there is no other
    };
    using Work = std::function<void()>;
    /// What the thread that waits does ten times a second, such as to draw a progress bar. Must not throw.
    using Meanwhile = std::function<void()>;

    explicit WorkerPool(const Limits& limits);
    /// Drops what no thread has begun, and waits for what one has.
    ~WorkerPool();
    WorkerPool(const WorkerPool&) = delete;
    WorkerPool& operator=(const WorkerPool&) = delete;

    /// Waits until there is room, and hands over. `work` runs on any thread; after it `deliver`, if there is one, in
    /// the order of the calls and never two at once. Both are destroyed before the item counts as finished. Throws what
    /// work threw first, once: nothing that was not begun by then is done any more.
    void add(uint64_t bytes, Work work, Work deliver = {}, const Meanwhile& meanwhile = {});
    /// Waits until all is finished. Throws like add().
    void finish(const Meanwhile& meanwhile = {});

    /// How many items are finished without an error.
    size_t finished() const;
    /// Seconds that add() and finish() waited, and that threads worked, one after the other.
    struct Times {
        double waited = 0, worked = 0, delivered = 0;
    };
    Times times() const;
    /// The most that was ever held at once.
    struct Peak {
        size_t items = 0;
        uint64_t bytes = 0;
    };
    Peak peak() const;

  private:
    struct Item {
        uint64_t bytes;
        Work work, deliver;
        bool done = false, well = false;  ///< worked on; and nothing threw
    };
    using Lock = std::unique_lock<std::mutex>;
    void start_thread();
    void run();
    void do_work(Lock& lock, const std::shared_ptr<Item>& item);
    void deliver_in_order(Lock& lock);
    void finish_item(const Item& item);
    void drop_waiting();
    /// Runs and destroys `given` without the lock, unless something threw before. False: it did not, or threw.
    bool attempt(Lock& lock, Work& given, double& seconds);
    template <typename Condition>
    void wait(Lock& lock, const Condition& condition, const Meanwhile& meanwhile);
    void throw_error();

    const Limits limits_;
    mutable std::mutex mutex_;
    std::condition_variable given_, finished_;
    std::deque<std::shared_ptr<Item>> waiting_;  ///< that no thread has begun
    std::deque<std::shared_ptr<Item>> ordered_;  ///< that are to be delivered
    std::vector<std::thread> threads_;
    size_t idle_ = 0, held_ = 0, count_ = 0;
    uint64_t bytes_ = 0;
    bool delivering_ = false, stopped_ = false, failed_ = false;
    std::exception_ptr error_;  ///< until it is thrown
    Times times_;
    Peak peak_;
};

}  // namespace peelray
