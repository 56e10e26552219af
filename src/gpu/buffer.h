// Device-local memory, and the picture that the rasteriser draws into.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "gpu/device.h"

namespace peelray {

/// A device-local storage buffer (also transfer source and target, and indirect arguments). Movable, freed when
/// destroyed.
class Buffer {
  public:
    enum class Where {
        device,
        upload,  ///< mapped staging memory, as is readback
        readback,
        ray_tracing,  ///< device-local as well, for acceleration structures, their builds and shader binding tables
    };

    Buffer() = default;
    /// `bytes` may be 0 (a buffer always has room for 16). Throws NoRoom beyond the device's limits or memory; `name`
    /// says what it is for.
    Buffer(Device& device, std::string name, uint64_t bytes, Where where = Where::device);
    ~Buffer() { reset(); }
    Buffer(Buffer&& other) noexcept { *this = std::move(other); }
    Buffer& operator=(Buffer&& other) noexcept;

    void reset();
    VkBuffer handle() const { return handle_; }
    uint64_t bytes() const { return bytes_; }
    const std::string& name() const { return name_; }
    /// On the device; of device and ray_tracing buffers, where the device has ray tracing.
    VkDeviceAddress address() const;
    std::byte* mapped() const { return mapped_; }
    explicit operator bool() const { return handle_ != VK_NULL_HANDLE; }

  private:
    Device* device_ = nullptr;
    std::string name_;
    VkBuffer handle_ = VK_NULL_HANDLE;
    VkDeviceMemory memory_ = VK_NULL_HANDLE;
    uint64_t bytes_ = 0, allocated_ = 0;
    std::byte* mapped_ = nullptr;
};

/// Makes `buffer` hold at least `bytes`; its contents are lost when it grows.
void ensure_size(Device& device, Buffer& buffer, const std::string& name, uint64_t bytes);

/// A 2-D image, or several layers of one size, with its views.
class Image2D {
  public:
    Image2D() = default;
    /// `array`: shaders see one layer as an array, too.
    Image2D(Device& device, const std::string& name, uint32_t width, uint32_t height, VkFormat format,
            VkImageUsageFlags usage, VkImageAspectFlags aspect, uint32_t layers = 1, bool array = false);
    ~Image2D() { reset(); }
    Image2D(Image2D&& other) noexcept { *this = std::move(other); }
    Image2D& operator=(Image2D&& other) noexcept;

    void reset();
    VkImage handle() const { return handle_; }
    VkFormat format() const { return format_; }
    VkImageAspectFlags aspect() const { return aspect_; }
    uint32_t layers() const { return layers_; }
    /// Of all layers; an array where there is more than one, or it was asked for.
    VkImageView view() const { return view_; }
    /// Of one of several layers.
    VkImageView layer_view(uint32_t layer) const { return layer_views_[layer]; }
    uint32_t width() const { return width_; }
    uint32_t height() const { return height_; }
    explicit operator bool() const { return handle_ != VK_NULL_HANDLE; }
    uint64_t bytes() const { return allocated_; }

    mutable VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;  ///< after all that is recorded; Commands keeps it

  private:
    VkImageView create_view(VkImageViewType type, uint32_t first, uint32_t count);

    Device* device_ = nullptr;
    VkImage handle_ = VK_NULL_HANDLE;
    VkImageView view_ = VK_NULL_HANDLE;
    VkDeviceMemory memory_ = VK_NULL_HANDLE;
    std::vector<VkImageView> layer_views_;
    uint64_t allocated_ = 0;
    uint32_t width_ = 0, height_ = 0, layers_ = 1;
    VkFormat format_ = VK_FORMAT_UNDEFINED;
    VkImageAspectFlags aspect_ = 0;
};

}  // namespace peelray
