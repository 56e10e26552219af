#include "gpu/buffer.h"

#include <algorithm>
#include <utility>

#include "base/error.h"

namespace peelray {

Buffer::Buffer(Device& device, std::string name, uint64_t bytes, Where where)
    : device_(&device), name_(std::move(name)), bytes_(std::max<uint64_t>(bytes, 16)) {
    const uint64_t most = device.limits().maxStorageBufferRange;
    if (where == Where::device && bytes_ > most)
        throw NoRoom(fmt::format("{:.0f} MiB of {} are more than the device '{}' binds at once ({:.0f} MiB)",
                                 double(bytes_) / (1 << 20), name_, device.info().name, double(most) / (1 << 20)),
                     device.room_advice());
    VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
    info.size = bytes_;
    info.usage = VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    const bool device_local = where == Where::device || where == Where::ray_tracing;
    if (device_local) info.usage |= VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT;
    if (where == Where::readback) info.usage |= VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;  // small results, without a copy
    const bool addressed = device_local && device.features.ray_tracing;
    if (addressed)
        info.usage |= VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT |
                      VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR;
    if (where == Where::ray_tracing)
        info.usage |=
            VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_STORAGE_BIT_KHR | VK_BUFFER_USAGE_SHADER_BINDING_TABLE_BIT_KHR;
    check_vulkan(device.vk.vkCreateBuffer(device.handle, &info, nullptr, &handle_), "creating the buffer " + name_);
    try {
        VkMemoryRequirements needs;
        device.vk.vkGetBufferMemoryRequirements(device.handle, handle_, &needs);
        const VkMemoryPropertyFlags host = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
        memory_ = device.allocate(
            needs, device_local ? VkMemoryPropertyFlags(VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT) : host,
            where == Where::readback ? VkMemoryPropertyFlags(VK_MEMORY_PROPERTY_HOST_CACHED_BIT) : 0, name_, addressed);
        allocated_ = needs.size;
        check_vulkan(device.vk.vkBindBufferMemory(device.handle, handle_, memory_, 0), "binding the buffer " + name_);
        if (!device_local) {
            void* pointer = nullptr;
            check_vulkan(device.vk.vkMapMemory(device.handle, memory_, 0, VK_WHOLE_SIZE, 0, &pointer),
                         "mapping the buffer " + name_);
            mapped_ = static_cast<std::byte*>(pointer);
        }
    } catch (...) {
        reset();
        throw;
    }
}

VkDeviceAddress Buffer::address() const {
    const VkBufferDeviceAddressInfo info{VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO, nullptr, handle_};
    return device_->vk.vkGetBufferDeviceAddress(device_->handle, &info);
}

void Buffer::reset() {
    if (!device_) return;
    if (handle_) device_->vk.vkDestroyBuffer(device_->handle, handle_, nullptr);
    if (memory_) device_->release(memory_, allocated_);
    handle_ = VK_NULL_HANDLE;
    memory_ = VK_NULL_HANDLE;
    bytes_ = allocated_ = 0;
    mapped_ = nullptr;
    device_ = nullptr;
}

Buffer& Buffer::operator=(Buffer&& other) noexcept {
    if (this == &other) return *this;
    reset();
    device_ = std::exchange(other.device_, nullptr);
    name_ = std::move(other.name_);
    handle_ = std::exchange(other.handle_, VkBuffer(VK_NULL_HANDLE));
    memory_ = std::exchange(other.memory_, VkDeviceMemory(VK_NULL_HANDLE));
    bytes_ = std::exchange(other.bytes_, 0);
    allocated_ = std::exchange(other.allocated_, 0);
    mapped_ = std::exchange(other.mapped_, nullptr);
    return *this;
}

void ensure_size(Device& device, Buffer& buffer, const std::string& name, uint64_t bytes) {
    if (buffer && buffer.bytes() >= bytes) return;
    buffer.reset();  // first, so that both never live at once
    buffer = Buffer(device, name, bytes);
}

Image2D::Image2D(Device& device, const std::string& name, uint32_t width, uint32_t height, VkFormat format,
                 VkImageUsageFlags usage, VkImageAspectFlags aspect, uint32_t layers, bool array)
    : device_(&device), width_(width), height_(height), layers_(layers), format_(format), aspect_(aspect) {
    VkImageCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = format;
    info.extent = {width, height, 1};
    info.mipLevels = 1;
    info.arrayLayers = layers;
    info.samples = VK_SAMPLE_COUNT_1_BIT;
    info.usage = usage;
    check_vulkan(device.vk.vkCreateImage(device.handle, &info, nullptr, &handle_), "creating the image " + name);
    try {
        VkMemoryRequirements needs;
        device.vk.vkGetImageMemoryRequirements(device.handle, handle_, &needs);
        memory_ = device.allocate(needs, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, 0, name);
        allocated_ = needs.size;
        check_vulkan(device.vk.vkBindImageMemory(device.handle, handle_, memory_, 0), "binding the image " + name);
        view_ = create_view(layers > 1 || array ? VK_IMAGE_VIEW_TYPE_2D_ARRAY : VK_IMAGE_VIEW_TYPE_2D, 0, layers);
        for (uint32_t i = 0; layers > 1 && i < layers; i++)
            layer_views_.push_back(create_view(VK_IMAGE_VIEW_TYPE_2D, i, 1));
    } catch (...) {
        reset();
        throw;
    }
}

VkImageView Image2D::create_view(VkImageViewType type, uint32_t first, uint32_t count) {
    VkImageViewCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
    info.image = handle_;
    info.viewType = type;
    info.format = format_;
    info.subresourceRange = {aspect_, 0, 1, first, count};
    VkImageView view = VK_NULL_HANDLE;
    check_vulkan(device_->vk.vkCreateImageView(device_->handle, &info, nullptr, &view), "viewing an image");
    return view;
}

void Image2D::reset() {
    if (!device_) return;
    for (VkImageView view : layer_views_) device_->vk.vkDestroyImageView(device_->handle, view, nullptr);
    layer_views_.clear();
    if (view_) device_->vk.vkDestroyImageView(device_->handle, view_, nullptr);
    if (handle_) device_->vk.vkDestroyImage(device_->handle, handle_, nullptr);
    if (memory_) device_->release(memory_, allocated_);
    view_ = VK_NULL_HANDLE;
    handle_ = VK_NULL_HANDLE;
    memory_ = VK_NULL_HANDLE;
    device_ = nullptr;
    allocated_ = 0;
    layout = VK_IMAGE_LAYOUT_UNDEFINED;
}

Image2D& Image2D::operator=(Image2D&& other) noexcept {
    if (this == &other) return *this;
    reset();
    device_ = std::exchange(other.device_, nullptr);
    handle_ = std::exchange(other.handle_, VkImage(VK_NULL_HANDLE));
    view_ = std::exchange(other.view_, VkImageView(VK_NULL_HANDLE));
    memory_ = std::exchange(other.memory_, VkDeviceMemory(VK_NULL_HANDLE));
    layer_views_ = std::exchange(other.layer_views_, {});
    allocated_ = std::exchange(other.allocated_, 0);
    layout = std::exchange(other.layout, VK_IMAGE_LAYOUT_UNDEFINED);
    width_ = other.width_;
    height_ = other.height_;
    layers_ = other.layers_;
    format_ = other.format_;
    aspect_ = other.aspect_;
    return *this;
}

}  // namespace peelray
