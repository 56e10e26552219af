#include "render/path_queues.h"

#include <algorithm>

#include "base/error.h"

namespace peelray {

PathQueues::PathQueues(Device& device) : device_(device) {
    const MemoryPart part(device, "frame");
    counters_ = Buffer(device, "queue counters", QUEUE_COUNTERS * 4);
    readback_ = Buffer(device, "queue counters readback", QUEUE_COUNTERS * 4, Buffer::Where::readback);
    groups_ = Buffer(device, "queue workgroups", QUEUE_LEVELS * 12);
}

void PathQueues::allocate(PathLevel& level, uint32_t index, uint32_t capacity) {
    if (capacity <= level.capacity) return;
    const auto name = [&](const char* what) { return fmt::format("{} of bounce {}", what, index); };
    level.capacity = capacity;
    ensure_size(device_, level.rays, name("rays"), uint64_t(capacity) * sizeof(Ray));
    ensure_size(device_, level.states, name("ray states"), uint64_t(capacity) * sizeof(RayState));
    ensure_size(device_, level.skip, name("ray origins"), uint64_t(capacity) * sizeof(SurfaceId));
    ensure_size(device_, level.hits, name("hits"), uint64_t(capacity) * sizeof(Hit));
    ensure_size(device_, level.nodes, name("path nodes"), uint64_t(capacity) * sizeof(PathNode));
}

void PathQueues::prepare(uint32_t pixels, uint32_t levels, bool branching) {
    // One level more than is traced: the deepest level's shader binds a next level that it never writes.
    levels_.resize(std::max<size_t>(levels_.size(), levels + 1));
    allocate(levels_[0], 0, pixels);
    for (uint32_t i = 1; i < levels; i++)
        allocate(levels_[i], i, std::max(1024u, branching || i == 1 ? pixels / 4 * 3 : pixels / 4));
    allocate(levels_[levels], levels, 64);
}

bool PathQueues::finish() {
    bool fits = true;
    for (uint32_t i = 1; i + 1 < levels_.size(); i++) {
        if (count(i) <= levels_[i].capacity) continue;
        fits = false;
        allocate(levels_[i], i, uint32_t(std::min<uint64_t>(uint64_t(count(i)) * 5 / 4 + 1024, 0xffffffffu)));
    }
    return fits;
}

uint64_t PathQueues::bytes() const {
    uint64_t sum = 0;
    for (const PathLevel& level : levels_)
        sum +=
            level.rays.bytes() + level.states.bytes() + level.skip.bytes() + level.hits.bytes() + level.nodes.bytes();
    return sum;
}

}  // namespace peelray
