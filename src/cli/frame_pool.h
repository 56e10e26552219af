// Finished frames on their way out: other threads encode and write them while the next ones are rendered.
#pragma once

#include <functional>
#include <optional>

#include "base/worker_pool.h"
#include "scene/picture.h"

namespace peelray {

class FramePool {
  public:
    /// `threads`: at most; frames that wait are bounded in number and by a share of the machine's memory.
    explicit FramePool(size_t threads);
    /// Drops frames that no thread has begun.
    ~FramePool() = default;

    using Work = std::function<void(const Picture& picture)>;
    /// Hands over a frame: WorkerPool::add(). Its memory can be had again from spare().
    void add(Picture picture, Work work, std::function<void()> deliver, const WorkerPool::Meanwhile& meanwhile);
    void finish(const WorkerPool::Meanwhile& meanwhile) { pool_.finish(meanwhile); }

    /// Of a frame that is done with.
    std::optional<Picture> spare();
    size_t finished() const { return pool_.finished(); }
    WorkerPool::Times times() const { return pool_.times(); }

  private:
    std::mutex mutex_;
    std::vector<Picture> spares_;
    WorkerPool pool_;  ///< last: what its threads use outlives them
};

}  // namespace peelray
