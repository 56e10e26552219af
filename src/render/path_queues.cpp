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

uint64_t PathRays::bytes() const {
    return rays.bytes() + states.bytes() + skip.bytes() + hits.bytes() + media.bytes() + walls.bytes();
}

void PathQueues::allocate(PathLevel& level, uint32_t index, uint32_t capacity) {
    const auto name = [&](const char* what) { return fmt::format("{} of bounce {}", what, index); };
    if (capacity > level.capacity) {
        ensure_size(device_, level.nodes, name("path nodes"), uint64_t(capacity) * sizeof(PathNode));
        ensure_size(device_, level.branches, name("path branches"), uint64_t(capacity) * sizeof(PathBranches));
        level.capacity = capacity;
    }
    PathRays& traced = *level.traced;
    if (index == 0 || level.capacity <= traced.capacity) return;
    ensure_size(device_, traced.rays, name("rays"), uint64_t(level.capacity) * sizeof(Ray));
    ensure_size(device_, traced.states, name("ray states"), uint64_t(level.capacity) * sizeof(RayState));
    ensure_size(device_, traced.skip, name("ray origins"), uint64_t(level.capacity) * sizeof(SurfaceId));
    ensure_size(device_, traced.hits, name("hits"), uint64_t(level.capacity) * sizeof(Hit));
    traced.capacity = level.capacity;
}

void PathQueues::keep_camera_rays() {
    PathLevel& level = levels_[0];
    PathRays& traced = *level.traced;
    ensure_size(device_, traced.rays, "camera rays", uint64_t(level.capacity) * sizeof(Ray));
    ensure_size(device_, traced.states, "states of camera rays", uint64_t(level.capacity) * sizeof(RayState));
    ensure_size(device_, traced.hits, "hits of camera rays", uint64_t(level.capacity) * sizeof(Hit));
    traced.capacity = level.capacity;
}

void PathQueues::share_rays(bool keeps) {
    for (size_t i = 0; i < levels_.size(); i++) {
        std::shared_ptr<PathRays>& own = levels_[i].traced;
        const bool shares = i > 2 && !keeps;
        if (shares) own = levels_[i - 2].traced;
        if (!own || (!shares && own.use_count() > 1 && i > 2)) own = std::make_shared<PathRays>();
    }
    keeps_ = keeps;
}

void PathQueues::allocate_lights(uint64_t capacity) {
    capacity = std::min<uint64_t>(capacity, most_lights_);
    if (capacity <= lights_.capacity) return;
    ensure_size(device_, lights_.rays, "shadow rays", capacity * sizeof(Ray));
    ensure_size(device_, lights_.skip, "origins of shadow rays", capacity * sizeof(SurfaceId));
    ensure_size(device_, lights_.light, "light of shadow rays", capacity * sizeof(glm::vec3));
    lights_.capacity = uint32_t(capacity);
}

/// Room for the media of all rays that there is room for.
void PathQueues::allocate_media() {
    if (!layered_) return;
    for (size_t i = 0; i < levels_.size(); i++) {
        PathRays& traced = *levels_[i].traced;
        ensure_size(device_, traced.media, fmt::format("media of bounce {}", i),
                    uint64_t(traced.capacity) * sizeof(MediaStack));
        ensure_size(device_, traced.walls, fmt::format("walls of media of bounce {}", i),
                    uint64_t(traced.capacity) * sizeof(MediaWall));
    }
    ensure_size(device_, lights_.media, "media of shadow rays", uint64_t(lights_.capacity) * sizeof(MediaStack));
}

std::vector<uint64_t> PathQueues::capacities(const Needs& needs) const {
    const auto [pixels, levels, usual, branching, lights, usual_lights, layered, keeps] = needs;
    // What is too little is counted and made again, once for all frames: half a millisecond on a GPU, where pictures
    // have rays at one pixel in eight or so, but seconds on a CPU.
    const bool sparing = !device_.immediate;
    std::vector<uint64_t> list = {pixels};
    for (uint32_t i = 1; i < levels; i++)
        list.push_back(std::max(1024u, i >= usual            ? pixels / 16
                                       : sparing             ? pixels / (i == 1 ? 4 : 8)
                                       : branching || i == 1 ? pixels / 4 * 3
                                                             : pixels / 4));
    // One level more than is traced: the deepest level's shader binds a next level that it never writes.
    list.push_back(64);
    // One ray a pixel is seldom exceeded; who has many lights finds out.
    const uint64_t shadow = uint64_t(pixels) * usual_lights / (sparing && usual_lights == 1 ? 2 : 1);
    list.push_back(std::min<uint64_t>(lights > 0 ? std::max<uint64_t>(1024, shadow) : 64, most_lights_));
    return list;
}

uint64_t PathQueues::bytes_of(const Needs& needs) const {
    const std::vector<uint64_t> list = capacities(needs);
    const uint64_t ray = sizeof(Ray) + sizeof(RayState) + sizeof(SurfaceId) + sizeof(Hit) +
                         (needs.layered ? sizeof(MediaStack) + sizeof(MediaWall) : 0);
    uint64_t sum = list.back() * (sizeof(Ray) + sizeof(SurfaceId) + sizeof(glm::vec3)) +
                   (needs.layered ? list.front() * ray + list.back() * sizeof(MediaStack) : 0);
    for (size_t i = 0; i + 1 < list.size(); i++) {
        sum += list[i] * (sizeof(PathNode) + sizeof(PathBranches));
        if (i > 0 && (needs.keeps || i <= 2)) sum += list[i] * ray;
    }
    return sum;
}

void PathQueues::prepare(const Needs& needs) {
    layered_ = needs.layered;
    const std::vector<uint64_t> list = capacities(needs);
    levels_.resize(std::max<size_t>(levels_.size(), needs.levels + 1));
    share_rays(needs.keeps);
    for (uint32_t i = 0; i <= needs.levels; i++) allocate(levels_[i], i, uint32_t(list[i]));
    allocate_lights(list.back());
    if (layered_) keep_camera_rays();
    allocate_media();
}

void PathQueues::release() {
    levels_.clear();
    lights_ = {};
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
    for (size_t i = 0; i < levels_.size(); i++) {
        sum += levels_[i].nodes.bytes() + levels_[i].branches.bytes();
        if (i <= 2 || keeps_) sum += levels_[i].traced->bytes();
    }
    return sum;
}

}  // namespace peelray
