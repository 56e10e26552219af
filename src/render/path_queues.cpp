#include "render/path_queues.h"

#include <algorithm>

#include "base/error.h"
#include "common/ray.h"

namespace peelray {
namespace {

/// Shadow rays in one queue, whatever the device binds: 832 MiB.
constexpr uint64_t kMostLights = 16u << 20;

uint32_t with_room_to_grow(uint32_t count) {
    return uint32_t(std::min<uint64_t>(uint64_t(count) * 5 / 4 + 1024, 0xffffffffu));
}

}  // namespace

PathQueues::PathQueues(Device& device)
    : device_(device),
      most_lights_(uint32_t(std::min(kMostLights, device.limits().maxStorageBufferRange / sizeof(Ray)))) {
    const MemoryPart part(device, "frame");
    counters_ = Buffer(device, "queue counters", QUEUE_WORDS * 4);
    readback_ = Buffer(device, "queue counters readback", QUEUE_COUNTERS * 4, Buffer::Where::readback);
}

void PathQueues::allocate(PathLevel& level, uint32_t index, uint32_t capacity) {
    if (capacity <= level.capacity) return;
    const auto name = [&](const char* what) { return fmt::format("{} of bounce {}", what, index); };
    level.capacity = capacity;
    ensure_size(device_, level.nodes, name("path nodes"), uint64_t(capacity) * sizeof(PathNode));
    ensure_size(device_, level.branches, name("path branches"), uint64_t(capacity) * sizeof(PathBranches));
    if (index == 0) return;
    ensure_size(device_, level.rays, name("rays"), uint64_t(capacity) * sizeof(Ray));
    ensure_size(device_, level.states, name("ray states"), uint64_t(capacity) * sizeof(RayState));
    ensure_size(device_, level.skip, name("ray origins"), uint64_t(capacity) * sizeof(SurfaceId));
    ensure_size(device_, level.hits, name("hits"), uint64_t(capacity) * sizeof(Hit));
}

void PathQueues::keep_camera_rays() {
    PathLevel& level = levels_[0];
    ensure_size(device_, level.rays, "camera rays", uint64_t(level.capacity) * sizeof(Ray));
    ensure_size(device_, level.states, "states of camera rays", uint64_t(level.capacity) * sizeof(RayState));
    ensure_size(device_, level.hits, "hits of camera rays", uint64_t(level.capacity) * sizeof(Hit));
}

void PathQueues::allocate_lights(uint64_t capacity) {
    capacity = std::min<uint64_t>(capacity, most_lights_);
    if (capacity <= lights_.capacity) return;
    lights_.capacity = uint32_t(capacity);
    ensure_size(device_, lights_.rays, "shadow rays", capacity * sizeof(Ray));
    ensure_size(device_, lights_.skip, "origins of shadow rays", capacity * sizeof(SurfaceId));
    ensure_size(device_, lights_.light, "light of shadow rays", capacity * sizeof(glm::vec3));
}

/// Room for the media of all rays that there is room for.
void PathQueues::allocate_media() {
    if (!layered_) return;
    for (size_t i = 0; i < levels_.size(); i++) {
        PathLevel& level = levels_[i];
        ensure_size(device_, level.media, fmt::format("media of bounce {}", i),
                    uint64_t(level.capacity) * sizeof(MediaStack));
        ensure_size(device_, level.walls, fmt::format("walls of media of bounce {}", i),
                    uint64_t(level.capacity) * sizeof(MediaWall));
    }
    ensure_size(device_, lights_.media, "media of shadow rays", uint64_t(lights_.capacity) * sizeof(MediaStack));
}

void PathQueues::prepare(const Needs& needs) {
    const auto [pixels, levels, usual, branching, lights, usual_lights, layered] = needs;
    layered_ = layered;
    // One level more than is traced: the deepest level's shader binds a next level that it never writes.
    levels_.resize(std::max<size_t>(levels_.size(), levels + 1));
    allocate(levels_[0], 0, pixels);
    for (uint32_t i = 1; i < levels; i++)
        allocate(levels_[i], i,
                 std::max(1024u, i >= usual            ? pixels / 16
                                 : branching || i == 1 ? pixels / 4 * 3
                                                       : pixels / 4));
    allocate(levels_[levels], levels, 64);
    // One ray a pixel is seldom exceeded; who has many lights finds out.
    allocate_lights(lights > 0 ? std::max<uint64_t>(1024, uint64_t(pixels) * usual_lights) : 64);
    if (layered) keep_camera_rays();
    allocate_media();
}

bool PathQueues::finish() {
    bool fits = true;
    for (uint32_t i = 1; i + 1 < levels_.size(); i++) {
        if (count(i) <= levels_[i].capacity) continue;
        fits = false;
        allocate(levels_[i], i, with_room_to_grow(count(i)));
    }
    if (count(QUEUE_LIGHT) > lights_.capacity) {
        fits = false;
        allocate_lights(with_room_to_grow(count(QUEUE_LIGHT)));
    }
    if (!fits) allocate_media();
    return fits;
}

uint64_t PathQueues::bytes() const {
    uint64_t sum = lights_.rays.bytes() + lights_.skip.bytes() + lights_.light.bytes() + lights_.media.bytes();
    for (const PathLevel& level : levels_)
        sum += level.rays.bytes() + level.states.bytes() + level.skip.bytes() + level.hits.bytes() +
               level.nodes.bytes() + level.branches.bytes() + level.media.bytes() + level.walls.bytes();
    return sum;
}

}  // namespace peelray
