// The Vulkan device: found by name or number, created without a window system.
#pragma once

#include <volk.h>
#include <array>

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "gpu/constants.h"

namespace peelray {

class Image2D;
class Pass;
class PipelineCache;
class RasterPass;
class RayPass;
struct RasterSetup;
struct RaySetup;

/// One physical device, as `peelray devices` lists it.
struct DeviceInfo {
    uint32_t index;          ///< position in this list: as DeviceOptions::select takes it
    std::string name, kind;  ///< kind: "discrete", "integrated", "virtual", "CPU" or "other"
    std::string driver, api_version;
    uint64_t memory;      ///< bytes of the largest device-local heap
    bool usable;          ///< offers what Peelray needs
    std::string lacking;  ///< what is missing, if not usable
};

/// How a device is opened.
struct DeviceOptions {
    std::string select;     ///< index or part of the name (case-insensitive); empty: the first of discrete, integrated,
                            ///< virtual, CPU
    bool validate = false;  ///< Vulkan validation layers; every message is collected (Device::validation_messages)
    uint64_t memory_limit = 0;  ///< bytes held by buffers and images at most; 0: as many as there are
    /// For tests of what happens at the limits of a device: it is taken to bind, and to hold, only so many bytes; 0: as
    /// many as it does. PEELRAY_MOST_BOUND and PEELRAY_MOST_HELD in the environment set them for whole programs.
    uint64_t most_bound = 0, most_held = 0;
};

/// Is Vulkan's library installed? It is loaded when it is first asked for.
bool has_vulkan_loader();
/// All devices of the installed drivers, best first. Throws Error if there is no Vulkan loader or no driver.
std::vector<DeviceInfo> list_devices();
/// The one that DeviceOptions::select names. Throws Error as making it does.
DeviceInfo device_info(const std::string& select);

/// What a device may offer beyond what all passes need; true where it is available.
struct DeviceFeatures {
    bool geometry_shader = false, tessellation_shader = false;
    bool fragment_stores = false;        ///< fragment shaders write buffers, with atomics
    bool fragment_subgroups = false;     ///< subgroup arithmetic in fragment shaders
    bool first_instance = false;         ///< indirect draws count instances from any number
    bool executable_properties = false;  ///< Pass::statistics() tells something
    bool int64_atomics = false;          ///< 64-bit integers, and atomics on them in buffers
    /// VK_EXT_conservative_rasterization that grows triangles by this many pixels more than it must, however thin they
    /// are; 0: not offered.
    float overestimation = 0;
    bool ray_tracing = false;    ///< VK_KHR_acceleration_structure and VK_KHR_ray_tracing_pipeline
    bool indirect_rays = false;  ///< launches of rays whose number is read on the GPU
    bool skips_boxes = false;    ///< pipelines may say that there is nothing but triangles
};

/// What the device's ray tracing asks for; with DeviceFeatures::ray_tracing.
struct RayTracingLimits {
    uint32_t handle_bytes = 0, handle_alignment = 1, table_alignment = 1;  ///< of shader binding tables
    uint32_t scratch_alignment = 1;                                        ///< of builds
    uint64_t most_triangles = 0;                                           ///< of an acceleration structure
    uint64_t most_instances = 0;
    uint64_t most_rays = 0;  ///< of a launch
};

/// A piece of device memory: the part of the program that it belongs to and what it holds.
struct Allocation {
    std::string part, name;
    uint64_t bytes;
};

/// A logical device with one queue that does graphics, compute and transfer.
class Device {
  public:
    explicit Device(const DeviceOptions& options = {});
    ~Device();
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;

    const DeviceInfo& info() const { return info_; }
    const VkPhysicalDeviceLimits& limits() const { return properties_.limits; }
    const VkPhysicalDeviceProperties& properties() const { return properties_; }
    /// Nanoseconds per timestamp tick; 0: the queue cannot time.
    double timestamp_period() const { return timestamp_period_; }

    /// The pass named like its shader file, made once and kept (shaders/*/NAME.comp). Every specialisation constant of
    /// the shader must be given once, by its name (asserted); each combination of values is a pass of its own.
    const Pass& pass(std::string_view shader, const Constants& constants = {});

    /// The rasterising pass whose fragment shader is NAME.frag, made once and kept for each setup.
    const RasterPass& raster_pass(std::string_view shader, const RasterSetup& setup);

    /// The ray tracing pass whose ray generation shader is NAME.rgen, made once and kept for each setup.
    const RayPass& ray_pass(std::string_view shader, const RaySetup& setup);

    /// Throws Error that says what is missing unless rays can be traced by the device's own means.
    void check_ray_tracing() const;
    const RayTracingLimits& ray_tracing_limits() const { return ray_tracing_limits_; }

    /// What the validation layers said so far, one message each; empty without `validate`.
    const std::vector<std::string>& validation_messages() const { return validation_messages_; }
    /// Throws Error with the first message if there is any.
    void check_validation() const;

    /// Device memory held by buffers and images now, and the most so far, in bytes.
    uint64_t allocated() const { return allocated_; }
    uint64_t peak_allocated() const { return peak_allocated_; }
    /// Each piece of it, in the order in which they were made: what is held now, and what was at the peak.
    std::vector<Allocation> allocations() const;
    const std::vector<Allocation>& peak_allocations() const { return at_peak_; }
    /// Bytes that may still be held; ~0: nobody knows.
    uint64_t room() const { return most_held_ == ~0ull ? most_held_ : most_held_ - std::min(allocated_, most_held_); }
    /// Bytes of a piece of a copy between host and device, of those that are too large for one.
    uint64_t staging_bytes() const;
    /// What to do where there is no room for what is being made: it depends on the part of the program.
    std::string room_advice() const;
    /// Starts counting the peak again from what is allocated now.
    void reset_peak();

    // For the classes of this folder.
    VkDevice handle = VK_NULL_HANDLE;
    VkPhysicalDevice physical = VK_NULL_HANDLE;
    VkQueue queue = VK_NULL_HANDLE;
    uint32_t queue_family = 0;
    VolkDeviceTable vk{};
    /// Software devices run passes lazily, so that their timestamps tell nothing: each pass is submitted alone there
    /// and timed by the host's clock. Not under validation, which is to see the passes and their barriers together.
    bool immediate = false;
    DeviceFeatures features;  ///< tests turn some off
    bool labels = false;      ///< VK_EXT_debug_utils is on: passes name themselves
    /// Traversals are compiled for the very number of instances up to this; beyond, for any. Tests of pictures lower
    /// it: each number is compiled for seconds on a CPU.
    uint32_t counted_instances = 8;
    /// Bound where a variant of a shader does not use a buffer that it declares (Binding::if_used). Those that the
    /// shader could write have one of their own: by what is declared alone, a write that nobody does would otherwise
    /// seem to need a barrier before the reads that nobody does.
    VkBuffer dummy(bool written) const { return dummies_[written]; }
    const Image2D& dummy_image() const { return *dummy_image_; }
    /// `addressed`: of a buffer with VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT.
    VkDeviceMemory allocate(const VkMemoryRequirements& needs, VkMemoryPropertyFlags wanted, VkMemoryPropertyFlags nice,
                            std::string_view what, bool addressed = false);
    void release(VkDeviceMemory memory, uint64_t size);

  private:
    friend class MemoryPart;
    struct State;
    void create_logical(bool validate);
    void lower_limits(const DeviceOptions& options);
    void create_dummies();
    VkDeviceMemory allocate_uncounted(const VkMemoryRequirements& needs, VkMemoryPropertyFlags wanted,
                                      VkMemoryPropertyFlags nice, std::string_view what, bool addressed);
    static VKAPI_ATTR VkBool32 VKAPI_CALL on_message(VkDebugUtilsMessageSeverityFlagBitsEXT,
                                                     VkDebugUtilsMessageTypeFlagsEXT,
                                                     const VkDebugUtilsMessengerCallbackDataEXT*, void*);

    DeviceInfo info_;
    std::unique_ptr<Image2D> dummy_image_;
    std::array<VkBuffer, 2> dummies_{};
    std::array<VkDeviceMemory, 2> dummy_memory_{};
    VkPhysicalDeviceProperties properties_{};
    VkPhysicalDeviceMemoryProperties memory_{};
    RayTracingLimits ray_tracing_limits_;
    std::string ray_tracing_lacking_;  ///< why there is none
    double timestamp_period_ = 0;
    VkInstance instance_ = VK_NULL_HANDLE;
    VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
    std::vector<std::string> validation_messages_;
    uint64_t allocated_ = 0, peak_allocated_ = 0, most_held_ = ~0ull;
    uint64_t memory_limit_ = 0;  ///< DeviceOptions::memory_limit
    std::vector<std::pair<VkDeviceMemory, Allocation>> held_;
    std::vector<Allocation> at_peak_;
    const char* part_ = "other";
    std::unique_ptr<State> state_;
};

/// While it lives, memory is accounted for as this part of the program. Of several the innermost counts.
class MemoryPart {
  public:
    MemoryPart(Device& device, const char* part) : device_(device), outer_(std::exchange(device.part_, part)) {}
    ~MemoryPart() { device_.part_ = outer_; }
    MemoryPart(const MemoryPart&) = delete;
    MemoryPart& operator=(const MemoryPart&) = delete;

  private:
    Device& device_;
    const char* outer_;
};

/// Throws Error naming `what` unless `result` is VK_SUCCESS; NoRoom where memory ran out.
void check_vulkan(VkResult result, std::string_view what);

}  // namespace peelray
