// The buffers of the tree of rays below a band of pixels: one set per level (bounce).
#pragma once

#include <vector>

#include "gpu/buffer.h"
#include "params.h"

namespace peelray {

/// A level's rays, their hits and the tree's nodes; entry i of each belongs to the same ray.
struct PathLevel {
    uint32_t capacity = 0;
    Buffer rays, states, skip, hits, nodes;
};

/// Makes room on demand: level 0 for a band's pixels, deeper levels by what the last band needed.
class PathQueues {
  public:
    explicit PathQueues(Device& device);

    /// Room for `pixels` camera rays and `levels` levels in all; `branching`: hits may start two rays.
    void prepare(uint32_t pixels, uint32_t levels, bool branching);

    /// Reads the counters of a finished submission; true if every queue fitted, else the queues have grown.
    bool finish();

    PathLevel& level(uint32_t index) { return levels_[index]; }
    const Buffer& counters() const { return counters_; }
    /// Of each level uvec3 workgroups, then of each the rays in its queue: uvec3(count, 1, 1).
    const Buffer& groups() const { return groups_; }
    static uint64_t launch_offset(uint32_t level) { return (QUEUE_LEVELS + level) * 12ull; }
    const Buffer& readback() const { return readback_; }
    /// A counter (QUEUE_*) of the last finished band.
    uint32_t count(uint32_t counter) const { return reinterpret_cast<const uint32_t*>(readback_.mapped())[counter]; }
    uint64_t bytes() const;

  private:
    void allocate(PathLevel& level, uint32_t index, uint32_t capacity);

    Device& device_;
    std::vector<PathLevel> levels_;
    Buffer counters_, readback_, groups_;
};

}  // namespace peelray
