#include "gpu/commands.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "base/error.h"

namespace peelray {
namespace {

constexpr uint32_t kSetsPerPool = 256, kBindingsPerSet = 16;
constexpr uint32_t kTimersPerPool = 512;
// Indirect arguments are read in a stage of their own.
constexpr VkPipelineStageFlags2 kCompute =
    VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT;
constexpr VkPipelineStageFlags2 kTransfer = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT;
constexpr VkPipelineStageFlags2 kGraphics = VK_PIPELINE_STAGE_2_ALL_GRAPHICS_BIT;
constexpr uint64_t kStagingBytes = 64ull << 20;  // larger copies go in pieces

double milliseconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

std::vector<Binding> declared(const PassBase& pass, std::vector<Binding> bindings) {
    std::erase_if(bindings, [&](const Binding& binding) { return !pass.interface().declares(binding.name); });
    return bindings;
}

Commands::Commands(Device& device)
    : device_(device),
      work_(VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT |
            VK_PIPELINE_STAGE_2_ALL_GRAPHICS_BIT) {
    if (device.features.ray_tracing)
        work_ |=
            VK_PIPELINE_STAGE_2_RAY_TRACING_SHADER_BIT_KHR | VK_PIPELINE_STAGE_2_ACCELERATION_STRUCTURE_BUILD_BIT_KHR;
    VkCommandPoolCreateInfo pool{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO, nullptr,
                                 VK_COMMAND_POOL_CREATE_TRANSIENT_BIT, device.queue_family};
    check_vulkan(device.vk.vkCreateCommandPool(device.handle, &pool, nullptr, &pool_), "creating a command pool");
    VkCommandBufferAllocateInfo info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO, nullptr, pool_,
                                     VK_COMMAND_BUFFER_LEVEL_PRIMARY, 1};
    check_vulkan(device.vk.vkAllocateCommandBuffers(device.handle, &info, &commands_), "creating a command buffer");
    VkFenceCreateInfo fence{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
    check_vulkan(device.vk.vkCreateFence(device.handle, &fence, nullptr, &fence_), "creating a fence");
}

Commands::~Commands() {
    for (auto pool : set_pools_) device_.vk.vkDestroyDescriptorPool(device_.handle, pool, nullptr);
    for (auto pool : query_pools_) device_.vk.vkDestroyQueryPool(device_.handle, pool, nullptr);
    device_.vk.vkDestroyFence(device_.handle, fence_, nullptr);
    device_.vk.vkDestroyCommandPool(device_.handle, pool_, nullptr);
}

void Commands::begin() {
    if (recording_) return;
    recording_ = true;
    check_vulkan(device_.vk.vkResetCommandPool(device_.handle, pool_, 0), "resetting a command pool");
    for (auto pool : set_pools_) device_.vk.vkResetDescriptorPool(device_.handle, pool, 0);
    set_pool_ = 0;
    timed_.clear();
    accesses_.clear();
    VkCommandBufferBeginInfo info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO, nullptr,
                                  VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT, nullptr};
    check_vulkan(device_.vk.vkBeginCommandBuffer(commands_, &info), "recording commands");
    stages_ = work_;  // earlier submissions' writes
    barrier();
    stages_ = 0;
    if (!time_passes_) whole_timer_ = start_timer("all passes");
    if (!time_passes_ && !whole_start_) whole_start_ = std::chrono::steady_clock::now();
}

void Commands::touch(uint64_t handle, bool reads, bool writes, bool& hazard) {
    const auto found = accesses_.find(handle);
    if (found == accesses_.end()) return;
    hazard |= (found->second.written && (reads || writes)) || (found->second.read && writes);
}

void Commands::touch(const Image2D& image, bool writes, bool fresh, VkImageLayout layout, bool& hazard) {
    touch(uint64_t(image.handle()), !writes, writes, hazard);
    if (image.layout == layout) return;
    hazard = true;
    VkImageMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2};
    barrier.srcStageMask = barrier.dstStageMask = work_;
    barrier.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT;
    barrier.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
    barrier.oldLayout = fresh ? VK_IMAGE_LAYOUT_UNDEFINED : image.layout;
    barrier.newLayout = layout;
    barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.image = image.handle();
    barrier.subresourceRange = {image.aspect(), 0, 1, 0, image.layers()};
    transitions_.push_back(barrier);
    image.layout = layout;
}

void Commands::touch(const AccelerationStructure& structure, bool& hazard) {
    touch(structure.storage(), true, false, hazard);
    for (const Buffer* shown : structure.shown) touch(*shown, true, false, hazard);
}

void Commands::barrier_if(bool hazard, VkPipelineStageFlags2 stages) {
    // A barrier is no wider than what is recorded, so that compute passes wait for compute alone: stages that come in
    // later were in none of the barriers so far.
    const bool late = stages_ != 0 && (stages_ & stages) != stages;
    stages_ |= stages;
    if (hazard || late) barrier();
}

void Commands::barrier() {
    VkMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
    barrier.srcStageMask = stages_;
    barrier.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT;
    barrier.dstStageMask = stages_;
    barrier.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
    VkDependencyInfo info{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    info.memoryBarrierCount = 1;
    info.pMemoryBarriers = &barrier;
    info.imageMemoryBarrierCount = uint32_t(transitions_.size());
    info.pImageMemoryBarriers = transitions_.data();
    device_.vk.vkCmdPipelineBarrier2(commands_, &info);
    transitions_.clear();
    accesses_.clear();
}

VkDescriptorSet Commands::allocate_set(VkDescriptorSetLayout layout) {
    for (;; set_pool_++) {
        if (set_pool_ == set_pools_.size()) {
            const VkDescriptorPoolSize sizes[] = {{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, kSetsPerPool * kBindingsPerSet},
                                                  {VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, kSetsPerPool * 2},
                                                  {VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR, kSetsPerPool}};
            VkDescriptorPoolCreateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO, nullptr, 0, kSetsPerPool,
                                            device_.features.ray_tracing ? 3u : 2u,        sizes};
            VkDescriptorPool pool = VK_NULL_HANDLE;
            check_vulkan(device_.vk.vkCreateDescriptorPool(device_.handle, &info, nullptr, &pool),
                         "creating a descriptor pool");
            set_pools_.push_back(pool);
        }
        VkDescriptorSetAllocateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO, nullptr, set_pools_[set_pool_],
                                         1, &layout};
        VkDescriptorSet set = VK_NULL_HANDLE;
        const VkResult result = device_.vk.vkAllocateDescriptorSets(device_.handle, &info, &set);
        if (result == VK_SUCCESS) return set;
        if (result != VK_ERROR_OUT_OF_POOL_MEMORY && result != VK_ERROR_FRAGMENTED_POOL)
            check_vulkan(result, "allocating descriptors");
    }
}

VkDescriptorSet Commands::bind(const PassBase& pass, std::span<const Binding> bindings, bool& hazard) {
    const auto& wanted = pass.interface().bindings;
    if (bindings.size() != wanted.size())
        fail("the pass {} has {} bindings but was given {} (a programming error)", pass.name(), wanted.size(),
             bindings.size());
    // All is checked before anything is recorded: a refused pass leaves the recording as it was.
    std::vector<const Binding*> matched;
    for (const ShaderBinding& want : wanted) {
        const auto given = std::find_if(bindings.begin(), bindings.end(), [&](auto& b) { return b.name == want.name; });
        if (given == bindings.end())
            fail("the pass {} was not given '{}' (a programming error)", pass.name(), want.name);
        const bool is_given = want.structure ? given->structure && *given->structure
                              : want.image   ? given->image && *given->image
                                             : given->buffer && *given->buffer;
        if (!is_given)
            fail("the pass {} was given no {} for '{}' (a programming error)", pass.name(),
                 want.structure ? "acceleration structure"
                 : want.image   ? "image"
                                : "buffer",
                 want.name);
        matched.push_back(&*given);
    }
    const VkDescriptorSet set = allocate_set(pass.set_layout());
    std::vector<VkDescriptorBufferInfo> infos(wanted.size());
    std::vector<VkDescriptorImageInfo> image_infos(wanted.size());
    std::vector<VkAccelerationStructureKHR> structures(wanted.size());
    std::vector<VkWriteDescriptorSetAccelerationStructureKHR> structure_infos(wanted.size());
    std::vector<VkWriteDescriptorSet> writes;
    for (size_t i = 0; i < wanted.size(); i++) {
        const Binding& given = *matched[i];
        if (given.image)
            image_infos[i] = {VK_NULL_HANDLE, given.image->view(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
        else if (given.structure)
            structures[i] = given.structure->handle();
        else
            infos[i] = {given.buffer->handle(), 0, VK_WHOLE_SIZE};
        VkWriteDescriptorSet write{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                   nullptr,
                                   set,
                                   wanted[i].binding,
                                   0,
                                   1,
                                   descriptor_type(wanted[i]),
                                   &image_infos[i],
                                   &infos[i],
                                   nullptr};
        if (given.structure) {
            structure_infos[i] = {VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET_ACCELERATION_STRUCTURE_KHR, nullptr, 1,
                                  &structures[i]};
            write.pNext = &structure_infos[i];
        }
        writes.push_back(write);
        if (given.image)
            touch(*given.image, false, false, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, hazard);
        else if (given.structure)
            touch(*given.structure, hazard);
        else
            touch(*given.buffer, wanted[i].reads, wanted[i].writes, hazard);
    }
    device_.vk.vkUpdateDescriptorSets(device_.handle, uint32_t(writes.size()), writes.data(), 0, nullptr);
    return set;
}

void Commands::mark(std::span<const Binding> bindings, const PassBase& pass) {
    for (const auto& wanted : pass.interface().bindings) {
        const auto given =
            std::find_if(bindings.begin(), bindings.end(), [&](auto& b) { return b.name == wanted.name; });
        if (given->structure) {
            access(given->structure->storage()).read = true;
            for (const Buffer* shown : given->structure->shown) access(*shown).read = true;
            continue;
        }
        Access& done = given->image ? access(*given->image) : access(*given->buffer);
        done.read |= wanted.reads;
        done.written |= wanted.writes;
    }
}

void Commands::check_params(const PassBase& pass, size_t bytes) {
    if (bytes != pass.interface().push_constant_bytes)
        fail("the pass {} takes {} bytes of parameters but was given {} (a programming error)", pass.name(),
             pass.interface().push_constant_bytes, bytes);
}

VkDescriptorSet Commands::prepare(const PassBase& pass, std::span<const Binding> bindings, const Buffer* arguments,
                                  VkPipelineStageFlags2 stages) {
    begin();
    bool hazard = false;
    const VkDescriptorSet set = bind(pass, bindings, hazard);
    if (arguments) touch(*arguments, true, false, hazard);
    barrier_if(hazard, stages);
    mark(bindings, pass);
    if (arguments) access(*arguments).read = true;
    return set;
}

void Commands::start(const PassBase& pass, VkPipelineBindPoint point, VkDescriptorSet set, const void* params,
                     size_t bytes) {
    label(pass.name());
    begin_timer(pass.name());
    device_.vk.vkCmdBindPipeline(commands_, point, pass.pipeline());
    device_.vk.vkCmdBindDescriptorSets(commands_, point, pass.layout(), 0, 1, &set, 0, nullptr);
    device_.vk.vkCmdPushConstants(commands_, pass.layout(), pass.stages(), 0, uint32_t(bytes), params);
}

void Commands::finish() {
    end_timer();
    end_label();
}

void Commands::record(const Pass& pass, std::span<const Binding> bindings, const void* params, size_t bytes,
                      Groups groups, const Buffer* arguments, uint64_t offset) {
    check_params(pass, bytes);
    const auto& most = device_.limits().maxComputeWorkGroupCount;
    if (!arguments && (groups.x > most[0] || groups.y > most[1] || groups.z > most[2]))
        fail("the pass {} needs {}x{}x{} workgroups, more than the device '{}' runs: use a smaller {} or {}",
             pass.name(), groups.x, groups.y, groups.z, device_.info().name, setting::size, setting::ldc);
    const VkDescriptorSet set = prepare(pass, bindings, arguments, kCompute);
    start(pass, VK_PIPELINE_BIND_POINT_COMPUTE, set, params, bytes);
    if (arguments)
        device_.vk.vkCmdDispatchIndirect(commands_, arguments->handle(), offset);
    else
        device_.vk.vkCmdDispatch(commands_, groups.x, groups.y, groups.z);
    finish();
}

void Commands::record_draw(const RasterPass& pass, std::span<const Binding> bindings, const void* params, size_t bytes,
                           std::span<const DrawRange> ranges, const IndirectDraws* indirect, const DrawTargets& targets,
                           const Buffer* copied) {
    check_params(pass, bytes);
    assert(targets.colors.size() == pass.setup().colors.size());
    begin();
    bool hazard = false;
    const VkDescriptorSet set = bind(pass, bindings, hazard);
    for (const Image2D* color : targets.colors)
        touch(*color, true, true, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, hazard);
    if (targets.depth) touch(*targets.depth, true, true, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL, hazard);
    if (indirect) touch(indirect->arguments, true, false, hazard);
    if (copied) touch(*copied, false, true, hazard);
    barrier_if(hazard, kGraphics);
    mark(bindings, pass);
    for (const Image2D* color : targets.colors) access(*color).written = true;
    if (targets.depth) access(*targets.depth).written = true;
    if (indirect) access(indirect->arguments).read = true;
    if (copied) access(*copied).written = true;

    start(pass, VK_PIPELINE_BIND_POINT_GRAPHICS, set, params, bytes);
    const uint32_t draws = indirect ? indirect->draws : uint32_t(ranges.size());
    assert(!targets.apart || draws == targets.layers);
    // Nothing to draw still clears the targets.
    for (uint32_t i = 0; i < std::max(draws, 1u); i++) {
        if (i == 0 || targets.apart) begin_rendering(pass, targets, i);
        if (indirect)
            device_.vk.vkCmdDrawIndirect(commands_, indirect->arguments.handle(),
                                         indirect->offset + i * sizeof(VkDrawIndirectCommand), 1, 0);
        else if (i < draws)
            device_.vk.vkCmdDraw(commands_, 3 * ranges[i].triangles, ranges[i].instances, 3 * ranges[i].first_triangle,
                                 ranges[i].first_instance);
        if (i + 1 >= draws || targets.apart) device_.vk.vkCmdEndRendering(commands_);
    }
    if (copied) {
        const Image2D& color = *targets.colors[0];
        bool wait = false;
        touch(color, false, false, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, wait);
        barrier_if(wait, kTransfer);
        VkBufferImageCopy region{};
        region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
        region.imageExtent = {color.width(), color.height(), 1};
        device_.vk.vkCmdCopyImageToBuffer(commands_, color.handle(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                                          copied->handle(), 1, &region);
        access(color).read = true;
        access(*copied).written = true;
    }
    finish();
}

void Commands::begin_rendering(const RasterPass& pass, const DrawTargets& targets, uint32_t layer) {
    const auto attachment = [&](const Image2D& image, VkImageLayout layout) {
        VkRenderingAttachmentInfo info{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
        info.imageView = targets.apart ? image.layer_view(layer) : image.view();
        info.imageLayout = layout;
        info.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
        info.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
        return info;
    };
    std::vector<VkRenderingAttachmentInfo> colors;
    for (const Image2D* image : targets.colors) {
        colors.push_back(attachment(*image, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL));
        if (image->format() == VK_FORMAT_R32G32_UINT)
            colors.back().clearValue.color.uint32[0] = colors.back().clearValue.color.uint32[1] = ~0u;
    }
    VkRenderingInfo rendering{VK_STRUCTURE_TYPE_RENDERING_INFO};
    rendering.renderArea.extent = {targets.width, targets.height};
    rendering.layerCount = targets.apart ? 1 : targets.layers;
    rendering.colorAttachmentCount = uint32_t(colors.size());
    rendering.pColorAttachments = colors.data();
    VkRenderingAttachmentInfo depth{};
    if (targets.depth) {
        depth = attachment(*targets.depth, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL);
        depth.storeOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
        depth.clearValue.depthStencil.depth = pass.setup().depth == VK_COMPARE_OP_GREATER ? 0.0f : 1.0f;
        rendering.pDepthAttachment = &depth;
    }
    const uint32_t side = targets.viewport;
    const VkViewport viewport{0, 0, float(side ? side : targets.width), float(side ? side : targets.height), 0, 1};
    const VkRect2D scissor{{0, 0}, {targets.width, targets.height}};
    device_.vk.vkCmdBeginRendering(commands_, &rendering);
    device_.vk.vkCmdSetViewport(commands_, 0, 1, &viewport);
    device_.vk.vkCmdSetScissor(commands_, 0, 1, &scissor);
}

void Commands::fill(const Buffer& buffer, uint32_t value, uint64_t offset, uint64_t bytes) {
    begin();
    bool hazard = false;
    touch(buffer, false, true, hazard);
    barrier_if(hazard, kTransfer);
    access(buffer).written = true;
    begin_timer("fill " + buffer.name());
    device_.vk.vkCmdFillBuffer(commands_, buffer.handle(), offset, bytes == ~0ull ? VK_WHOLE_SIZE : bytes, value);
    end_timer();
}

void Commands::copy(const Buffer& from, const Buffer& to, uint64_t bytes, uint64_t from_offset, uint64_t to_offset) {
    begin();
    bool hazard = false;
    touch(from, true, false, hazard);
    touch(to, false, true, hazard);
    barrier_if(hazard, kTransfer);
    access(from).read = true;
    access(to).written = true;
    const VkBufferCopy region{from_offset, to_offset, bytes};
    device_.vk.vkCmdCopyBuffer(commands_, from.handle(), to.handle(), 1, &region);
}

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

void Commands::flush() {
    if (!recording_) return;
    VkMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
    barrier.srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    barrier.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT;
    barrier.dstStageMask = VK_PIPELINE_STAGE_2_HOST_BIT;
    barrier.dstAccessMask = VK_ACCESS_2_HOST_READ_BIT;
    VkDependencyInfo dependency{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    dependency.memoryBarrierCount = 1;
    dependency.pMemoryBarriers = &barrier;
    device_.vk.vkCmdPipelineBarrier2(commands_, &dependency);
    check_vulkan(device_.vk.vkEndCommandBuffer(commands_), "recording commands");
    recording_ = false;

    VkCommandBufferSubmitInfo command{VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO, nullptr, commands_, 0};
    VkSubmitInfo2 info{VK_STRUCTURE_TYPE_SUBMIT_INFO_2};
    info.commandBufferInfoCount = 1;
    info.pCommandBufferInfos = &command;
    check_vulkan(device_.vk.vkQueueSubmit2(device_.queue, 1, &info, fence_), "submitting commands");
    check_vulkan(device_.vk.vkWaitForFences(device_.handle, 1, &fence_, VK_TRUE, ~0ull), "waiting for the GPU");
    check_vulkan(device_.vk.vkResetFences(device_.handle, 1, &fence_), "resetting a fence");
}

void Commands::upload_bytes(const Buffer& buffer, std::span<const std::byte> data, uint64_t offset) {
    if (offset + data.size() > buffer.bytes()) fail("an upload to {} is too long (a programming error)", buffer.name());
    submit();
    const MemoryPart part(device_, "staging");
    for (uint64_t done = 0; done < data.size();) {
        const uint64_t bytes = std::min<uint64_t>(data.size() - done, kStagingBytes);
        if (!staging_up_ || staging_up_.bytes() < bytes)
            staging_up_ = Buffer(device_, "upload staging", bytes, Buffer::Where::upload);
        std::memcpy(staging_up_.mapped(), data.data() + done, bytes);
        copy(staging_up_, buffer, bytes, 0, offset + done);
        submit();
        done += bytes;
    }
}

void Commands::download_bytes(const Buffer& buffer, std::span<std::byte> data, uint64_t offset) {
    if (offset + data.size() > buffer.bytes())
        fail("a download of {} is too long (a programming error)", buffer.name());
    submit();
    const MemoryPart part(device_, "staging");
    for (uint64_t done = 0; done < data.size();) {
        const uint64_t bytes = std::min<uint64_t>(data.size() - done, kStagingBytes);
        if (!staging_down_ || staging_down_.bytes() < bytes)
            staging_down_ = Buffer(device_, "readback staging", bytes, Buffer::Where::readback);
        copy(buffer, staging_down_, bytes, offset + done, 0);
        submit();
        std::memcpy(data.data() + done, staging_down_.mapped(), bytes);
        done += bytes;
    }
}

void grow(Device& device, Commands& commands, Buffer& buffer, const std::string& name, uint64_t bytes, uint64_t kept) {
    if (kept == 0 || !buffer) return ensure_size(device, buffer, name, bytes);
    if (buffer.bytes() >= bytes) return;
    Buffer larger(device, name, bytes);
    commands.copy(buffer, larger, kept);
    commands.submit();
    buffer = std::move(larger);
}

void shrink(Device& device, Commands& commands, Buffer& buffer, uint64_t bytes) {
    if (!buffer || bytes == 0 || buffer.bytes() <= std::max<uint64_t>(bytes, 16)) return;
    Buffer smaller(device, buffer.name(), bytes);
    commands.copy(buffer, smaller, bytes);
    commands.submit();
    buffer = std::move(smaller);
}

}  // namespace peelray
