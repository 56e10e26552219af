// Debug labels and timers of Commands around passes and groups of them, and submissions, which read the timers.
#include <algorithm>
#include <cassert>
#include <utility>

#include "gpu/commands.h"

namespace peelray {
namespace {

constexpr uint32_t kTimersPerPool = 512;

double milliseconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

void Commands::label(const std::string& name) {
    if (!device_.labels || device_.immediate || !vkCmdBeginDebugUtilsLabelEXT) return;
    VkDebugUtilsLabelEXT info{VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT, nullptr, name.c_str(), {}};
    vkCmdBeginDebugUtilsLabelEXT(commands_, &info);
}

void Commands::end_label() {
    if (device_.labels && !device_.immediate && vkCmdEndDebugUtilsLabelEXT) vkCmdEndDebugUtilsLabelEXT(commands_);
}

void Commands::begin_group(const std::string& name) {
    begin();
    assert(group_.empty());
    group_ = name;
    label(name);
    if (time_passes_) return;
    if (device_.immediate) {
        flush();
        group_start_ = std::chrono::steady_clock::now();
        return;
    }
    group_timer_ = start_timer("all");
}

void Commands::end_group() {
    if (!time_passes_ && device_.immediate && device_.timestamp_period() > 0) {
        flush();
        host_times_.push_back({group_ + "/all", milliseconds_since(group_start_)});
    } else if (!time_passes_) {
        stop_timer(group_timer_);
    }
    group_.clear();
    end_label();
}

void Commands::begin_timer(const std::string& name) {
    if (time_passes_) start_timer(name);
}

size_t Commands::start_timer(const std::string& name) {
    const size_t index = timed_.size();
    if (device_.timestamp_period() == 0) return index;
    timed_.push_back(group_.empty() ? name : group_ + "/" + name);
    if (device_.immediate) return index;
    if (index / kTimersPerPool == query_pools_.size()) {
        VkQueryPoolCreateInfo info{VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO};
        info.queryType = VK_QUERY_TYPE_TIMESTAMP;
        info.queryCount = 2 * kTimersPerPool;
        VkQueryPool pool = VK_NULL_HANDLE;
        check_vulkan(device_.vk.vkCreateQueryPool(device_.handle, &info, nullptr, &pool), "creating a query pool");
        query_pools_.push_back(pool);
    }
    const VkQueryPool pool = query_pools_[index / kTimersPerPool];
    const uint32_t query = uint32_t(2 * (index % kTimersPerPool));
    device_.vk.vkResetQueryPool(device_.handle, pool, query, 2);
    device_.vk.vkCmdWriteTimestamp2(commands_, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, pool, query);
    return index;
}

void Commands::end_timer() {
    if (device_.timestamp_period() == 0 || !time_passes_) return;
    if (device_.immediate) {
        const std::string name = timed_.back();
        const auto start = std::chrono::steady_clock::now();
        flush();
        host_times_.push_back({name, milliseconds_since(start)});
        return;
    }
    stop_timer(timed_.size() - 1);
}

void Commands::stop_timer(size_t index) {
    if (device_.timestamp_period() == 0 || device_.immediate) return;
    device_.vk.vkCmdWriteTimestamp2(commands_, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                                    query_pools_[index / kTimersPerPool], uint32_t(2 * (index % kTimersPerPool) + 1));
}

void Commands::read_times() {
    times_.clear();
    elapsed_ms_ = 0;
    uint64_t first = 0, ticks[2] = {};
    for (size_t i = 0; i < timed_.size(); i++) {
        check_vulkan(device_.vk.vkGetQueryPoolResults(device_.handle, query_pools_[i / kTimersPerPool],
                                                      uint32_t(2 * (i % kTimersPerPool)), 2, sizeof ticks, ticks, 8,
                                                      VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
                     "reading timestamps");
        times_.push_back({timed_[i], double(ticks[1] - ticks[0]) * device_.timestamp_period() * 1e-6});
        if (i == 0) first = ticks[0];
        elapsed_ms_ = std::max(elapsed_ms_, double(ticks[1] - first) * device_.timestamp_period() * 1e-6);
    }
}

void Commands::submit() {
    if (device_.immediate) {
        flush();
        times_ = std::exchange(host_times_, {});
        elapsed_ms_ = 0;
        for (const PassTime& time : times_) elapsed_ms_ += time.ms;
        if (!time_passes_ && whole_start_ && device_.timestamp_period() > 0) {
            elapsed_ms_ = milliseconds_since(*whole_start_);
            times_.push_back({"all passes", elapsed_ms_});
        }
        whole_start_.reset();
    } else if (recording_) {
        if (!time_passes_) stop_timer(whole_timer_);
        flush();
        read_times();
    }
}

}  // namespace peelray
