#include "base/worker_pool.h"

#include <algorithm>
#include <chrono>
#include <new>
#include <system_error>
#include <utility>

#include "base/elapsed.h"

namespace peelray {

using Clock = std::chrono::steady_clock;

WorkerPool::WorkerPool(const Limits& limits) : limits_(limits) {}

WorkerPool::~WorkerPool() {
    {
        const Lock lock(mutex_);
        stopped_ = failed_ = true;
        waiting_.clear();
    }
    given_.notify_all();
    for (std::thread& thread : threads_) thread.join();
}

void WorkerPool::add(uint64_t bytes, Work work, Work deliver, const Meanwhile& meanwhile) {
    Lock lock(mutex_);
    wait(
        lock,
        [&] {
            return held_ == 0 || (held_ < limits_.items && bytes_ <= limits_.bytes && bytes <= limits_.bytes - bytes_);
        },
        meanwhile);
    held_++;
    bytes_ += bytes;
    peak_ = {std::max(peak_.items, held_), std::max(peak_.bytes, bytes_)};
    waiting_.push_back(std::make_shared<Item>(Item{bytes, std::move(work), std::move(deliver)}));
    if (waiting_.back()->deliver) ordered_.push_back(waiting_.back());
    if (idle_ < waiting_.size() && threads_.size() < limits_.threads) start_thread();
    given_.notify_one();
}

void WorkerPool::start_thread() {
    try {
        threads_.emplace_back([this] { run(); });
    } catch (const std::system_error&) {
        // No more can be started: those that run do the work.
        if (threads_.empty()) throw std::bad_alloc();
    }
}

void WorkerPool::finish(const Meanwhile& meanwhile) {
    Lock lock(mutex_);
    wait(
        lock, [&] { return held_ == 0; }, meanwhile);
}

size_t WorkerPool::finished() const {
    const Lock lock(mutex_);
    return count_;
}

WorkerPool::Times WorkerPool::times() const {
    const Lock lock(mutex_);
    return times_;
}

WorkerPool::Peak WorkerPool::peak() const {
    const Lock lock(mutex_);
    return peak_;
}

/// Until the condition holds. After an error: until no thread works any more, and throws it.
template <typename Condition>
void WorkerPool::wait(Lock& lock, const Condition& condition, const Meanwhile& meanwhile) {
    const Clock::time_point start = Clock::now();
    while (failed_ ? held_ > 0 : !condition()) {
        finished_.wait_for(lock, std::chrono::milliseconds(100));
        if (!meanwhile) continue;
        lock.unlock();
        meanwhile();
        lock.lock();
    }
    times_.waited += seconds_since(start);
    throw_error();
}

void WorkerPool::throw_error() {
    failed_ = false;
    if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
}

void WorkerPool::run() {
    Lock lock(mutex_);
    for (;;) {
        idle_++;
        given_.wait(lock, [&] { return stopped_ || !waiting_.empty(); });
        idle_--;
        if (waiting_.empty()) return;
        const std::shared_ptr<Item> item = std::move(waiting_.front());
        waiting_.pop_front();
        do_work(lock, item);
    }
}

void WorkerPool::do_work(Lock& lock, const std::shared_ptr<Item>& item) {
    item->well = attempt(lock, item->work, times_.worked);
    item->done = true;
    if (item->deliver)
        deliver_in_order(lock);
    else
        finish_item(*item);
}

/// What is done and next, unless another thread is at it.
void WorkerPool::deliver_in_order(Lock& lock) {
    if (std::exchange(delivering_, true)) return;
    while (!ordered_.empty() && ordered_.front()->done) {
        const std::shared_ptr<Item> item = std::move(ordered_.front());
        ordered_.pop_front();
        item->well &= attempt(lock, item->deliver, times_.delivered);
        finish_item(*item);
    }
    delivering_ = false;
}

void WorkerPool::finish_item(const Item& item) {
    held_--;
    bytes_ -= item.bytes;
    count_ += item.well;
    finished_.notify_all();
}

bool WorkerPool::attempt(Lock& lock, Work& given, double& seconds) {
    Work work = std::exchange(given, {});
    const bool may = !failed_;
    lock.unlock();
    const Clock::time_point start = Clock::now();
    std::exception_ptr error;
    try {
        if (may) work();
    } catch (...) {
        error = std::current_exception();
    }
    work = {};
    const double spent = seconds_since(start);
    lock.lock();
    seconds += spent;
    if (error && !error_) error_ = error;
    if (error) drop_waiting();
    return may && !error;
}

void WorkerPool::drop_waiting() {
    failed_ = true;
    for (const std::shared_ptr<Item>& item : waiting_) {
        std::erase(ordered_, item);
        finish_item(*item);
    }
    waiting_.clear();
}

}  // namespace peelray
