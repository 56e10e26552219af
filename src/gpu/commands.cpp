#include "gpu/commands.h"

#include <algorithm>

#include "base/error.h"
#include "base/parallel.h"

namespace peelray {
namespace {

// Indirect arguments are read in a stage of their own.
constexpr VkPipelineStageFlags2 kCompute =
    VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT;

}  // namespace

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

void Commands::check_params(const PassBase& pass, size_t bytes) {
    if (bytes != pass.interface().push_constant_bytes)
        fail("the pass {} takes {} bytes of parameters but was given {} (a programming error)", pass.name(),
             pass.interface().push_constant_bytes, bytes);
}

VkDescriptorSet Commands::prepare(const PassBase& pass, std::span<const Binding> bindings, const Buffer* arguments,
                                  VkPipelineStageFlags2 stages) {
    const std::vector<const Binding*> given = match(pass, bindings);
    begin();
    bool hazard = false;
    const VkDescriptorSet set = bind(pass, given);
    touch(pass, given, hazard);
    if (arguments) touch(*arguments, true, false, hazard);
    barrier_if(hazard, stages);
    mark(pass, given);
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
        const uint64_t bytes = std::min<uint64_t>(data.size() - done, device_.staging_bytes());
        if (!staging_up_ || staging_up_.bytes() < bytes)
            staging_up_ = Buffer(device_, "upload staging", bytes, Buffer::Where::upload);
        std::memcpy(staging_up_.mapped(), data.data() + done, bytes);
        copy(staging_up_, buffer, bytes, 0, offset + done);
        submit();
        done += bytes;
    }
}

void Commands::upload(const Image2D& image, std::span<const uint32_t> texels, uint64_t first_row) {
    submit();
    const MemoryPart part(device_, "staging");
    const uint64_t width = image.width(), most_rows = std::max<uint64_t>(1, device_.staging_bytes() / (4 * width));
    for (uint64_t row = first_row; !texels.empty();) {
        // Whole rows, then what is left of the last one: a copy is a rectangle of one layer.
        const uint64_t left = image.height() - row % image.height(), rows = std::min(most_rows, left);
        const size_t taken = std::min<uint64_t>(texels.size(), rows * width);
        if (!staging_up_ || staging_up_.bytes() < taken * 4)
            staging_up_ = Buffer(device_, "upload staging", taken * 4, Buffer::Where::upload);
        std::memcpy(staging_up_.mapped(), texels.data(), taken * 4);
        std::vector<VkBufferImageCopy> regions;
        const auto add = [&](uint64_t first, uint64_t columns, uint64_t lines) {
            VkBufferImageCopy region{first * width * 4};
            region.imageSubresource = {image.aspect(), 0, uint32_t(row / image.height()), 1};
            region.imageOffset = {0, int32_t(row % image.height() + first), 0};
            region.imageExtent = {uint32_t(columns), uint32_t(lines), 1};
            if (columns && lines) regions.push_back(region);
        };
        add(0, width, taken / width);
        add(taken / width, taken % width, 1);
        begin();
        bool hazard = false;
        touch(staging_up_, true, false, hazard);
        touch(image, true, false, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, hazard);
        barrier_if(hazard, kTransfer);
        access(staging_up_).read = access(image).written = true;
        device_.vk.vkCmdCopyBufferToImage(commands_, staging_up_.handle(), image.handle(),
                                          VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, uint32_t(regions.size()),
                                          regions.data());
        submit();
        texels = texels.subspan(taken);
        row += rows;
    }
}

/// On several cores where there is much: one alone copies less than the device sends.
static void copy_out(const std::byte* from, std::byte* to, uint64_t bytes) {
    constexpr uint64_t kPiece = 2 << 20;
    parallel_for((bytes + kPiece - 1) / kPiece, 1, [&](size_t i) {
        const uint64_t first = i * kPiece;
        std::memcpy(to + first, from + first, std::min(kPiece, bytes - first));
    });
}

void Commands::download_bytes(const Buffer& buffer, std::span<std::byte> data, uint64_t offset) {
    if (offset + data.size() > buffer.bytes())
        fail("a download of {} is too long (a programming error)", buffer.name());
    submit();
    const MemoryPart part(device_, "staging");
    for (uint64_t done = 0; done < data.size();) {
        const uint64_t bytes = std::min<uint64_t>(data.size() - done, device_.staging_bytes());
        if (!staging_down_ || staging_down_.bytes() < bytes)
            staging_down_ = Buffer(device_, "readback staging", bytes, Buffer::Where::readback);
        copy(buffer, staging_down_, bytes, offset + done, 0);
        submit();
        copy_out(staging_down_.mapped(), data.data() + done, bytes);
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
