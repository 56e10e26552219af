#include "cli/frame_pool.h"

#include <algorithm>
#include <memory>

#include "base/cores.h"

namespace peelray {
namespace {

uint64_t bytes_of(const Picture& picture) {
    uint64_t bytes = picture.radiance.size() * sizeof(glm::vec4) + picture.encoded.size() * sizeof(uint32_t) +
                     picture.aovs.costs.size() * sizeof(RayCosts);
#define AOV_BYTES(name, type, channels, nothing) bytes += picture.aovs.name.size() * sizeof(picture.aovs.name[0]);
    SURFACE_AOVS(AOV_BYTES)
    RAY_SETUP_AOVS(AOV_BYTES)
    SAMPLE_AOVS(AOV_BYTES)
#undef AOV_BYTES
    return bytes;
}

/// An eighth of the machine's memory, within what one frame of 4096x4096 takes and what 64 threads can use.
uint64_t most_bytes() {
    return std::clamp<uint64_t>(machine_memory() / 8, uint64_t(256) << 20, uint64_t(8) << 30);
}

}  // namespace

FramePool::FramePool(size_t threads) : pool_({threads, 2 * threads + 2, most_bytes()}) {}

void FramePool::add(Picture picture, Work work, std::function<void()> deliver, const WorkerPool::Meanwhile& meanwhile) {
    const uint64_t bytes = bytes_of(picture);
    // std::function copies what it holds.
    const auto shared = std::make_shared<Picture>(std::move(picture));
    pool_.add(
        bytes,
        [this, shared, work = std::move(work)] {
            work(*shared);
            shared->aovs = {};
            const std::lock_guard lock(mutex_);
            spares_.push_back(std::move(*shared));
        },
        std::move(deliver), meanwhile);
}

std::optional<Picture> FramePool::spare() {
    const std::lock_guard lock(mutex_);
    if (spares_.empty()) return std::nullopt;
    Picture picture = std::move(spares_.back());
    spares_.pop_back();
    return picture;
}

}  // namespace peelray
