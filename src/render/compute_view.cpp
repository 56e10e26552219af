#include "render/compute_view.h"

#include <algorithm>

#include "base/error.h"
#include "view/view_params.h"

namespace peelray {
namespace {

constexpr uint64_t kBlockBytes = 8;
constexpr uint64_t kFirstBlocks = 1 << 16, kMostFirstBlocks = 1 << 20;

}  // namespace

bool ComputeView::possible(const Device& device, const GpuScene& scene) {
    return device.features.int64_atomics && scene.drawn <= 1ull << 31;
}

void ComputeView::record(Commands& commands, const GpuScene& scene, const ViewTarget& target, const PathQueues& queues,
                         const glm::vec2& jitter) {
    if (capacity_ == 0) capacity_ = uint32_t(std::clamp(scene.drawn, kFirstBlocks, kMostFirstBlocks));
    ensure_size(device_, blocks_, "blocks of large triangles", capacity_ * kBlockBytes);
    const Binding own[] = {{"frame", target.frame},
                           {"positions", scene.triangles.positions},
                           {"triangles", scene.triangles.triangles},
                           {"instances", scene.instances.table()},
                           {"draws", scene.draw_table},
                           {"visibility", target.visibility},
                           {"queue", queues.counters()},
                           {"blocks", blocks_}};
    const std::vector<Binding> bindings = with_hit_materials(own, scene.triangles);
    const ViewParams p{jitter, uint32_t(scene.drawn), capacity_};
    const bool masked = scene.triangles.masks != nullptr, single_sided = scene.triangles.sides != nullptr;
    commands.fill(target.visibility, ~0u);
    commands.run(device_.pass("view_triangles", {{"masked", masked}, {"single_sided", single_sided}}), bindings, p,
                 groups_for(scene.drawn, 256));
    commands.run_indirect(device_.pass("view_blocks", {{"masked", masked}}), bindings, p, queues.counters(),
                          PathQueues::groups_offset(QUEUE_GROUPS_VIEW));
}

bool ComputeView::finish(const PathQueues& queues) {
    const uint32_t needed = queues.count(QUEUE_VIEW_BLOCKS);
    if (needed <= capacity_) return true;
    const uint64_t most = device_.limits().maxStorageBufferRange / kBlockBytes;
    if (needed > most)
        fail(
            "large triangles cover {} blocks of the picture, more than the device '{}' binds: choose a smaller {}, or "
            "{} raster",
            needed, device_.info().name, setting::size, setting::visibility);
    capacity_ = uint32_t(std::min<uint64_t>(most, needed + needed / 4));
    return false;
}

}  // namespace peelray
