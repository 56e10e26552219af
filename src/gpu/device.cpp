#define VOLK_IMPLEMENTATION
#include "gpu/device.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <map>

#include "base/error.h"
#include "gpu/buffer.h"
#include "gpu/instance.h"
#include "gpu/pass.h"
#include "gpu/pipeline_cache.h"
#include "gpu/ray_pass.h"
#include "gpu/ray_tracing_support.h"

namespace peelray {

bool extension_available(VkPhysicalDevice device, const char* name) {
    uint32_t count = 0;
    vkEnumerateDeviceExtensionProperties(device, nullptr, &count, nullptr);
    std::vector<VkExtensionProperties> extensions(count);
    vkEnumerateDeviceExtensionProperties(device, nullptr, &count, extensions.data());
    return std::any_of(extensions.begin(), extensions.end(),
                       [&](auto& e) { return !std::strcmp(e.extensionName, name); });
}

/// What the device owns and makes on demand.
struct Device::State {
    std::unique_ptr<PipelineCache> cache;
    std::map<std::pair<std::string, Constants>, std::unique_ptr<Pass>> passes;
    std::map<std::pair<std::string, RasterSetup>, std::unique_ptr<RasterPass>> raster_passes;
    std::map<std::pair<std::string, RaySetup>, std::unique_ptr<RayPass>> ray_passes;
};

namespace {

/// A number of bytes from the environment; 0: none.
uint64_t bytes_from(const char* variable) {
    const char* text = std::getenv(variable);
    return text ? std::strtoull(text, nullptr, 10) : 0;
}

/// Triangles are snapped to 1/256 pixel or so first: growing by less could lose a pixel.
constexpr float kLeastOverestimation = 1.0f / 64;

/// Reads what the device offers and sets in `on` what of it is used.
DeviceFeatures optional_features(VkPhysicalDevice device, VkPhysicalDeviceFeatures& on,
                                 VkPhysicalDeviceVulkan12Features& on_v12) {
    VkPhysicalDeviceConservativeRasterizationPropertiesEXT conservative{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_CONSERVATIVE_RASTERIZATION_PROPERTIES_EXT};
    VkPhysicalDeviceSubgroupProperties subgroups{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES};
    VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &subgroups};
    const bool has_conservative = extension_available(device, VK_EXT_CONSERVATIVE_RASTERIZATION_EXTENSION_NAME);
    if (has_conservative) subgroups.pNext = &conservative;
    vkGetPhysicalDeviceProperties2(device, &properties);
    VkPhysicalDeviceVulkan12Features offered_v12{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
    VkPhysicalDeviceFeatures2 all{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &offered_v12};
    vkGetPhysicalDeviceFeatures2(device, &all);
    const VkPhysicalDeviceFeatures& offered = all.features;

    DeviceFeatures features;
    on.geometryShader = offered.geometryShader;
    on.tessellationShader = offered.tessellationShader;
    on.fragmentStoresAndAtomics = offered.fragmentStoresAndAtomics;
    on.drawIndirectFirstInstance = offered.drawIndirectFirstInstance;
    features.geometry_shader = on.geometryShader == VK_TRUE;
    features.tessellation_shader = on.tessellationShader == VK_TRUE;
    features.fragment_stores = on.fragmentStoresAndAtomics == VK_TRUE;
    features.first_instance = on.drawIndirectFirstInstance == VK_TRUE;
    features.int64_atomics = offered.shaderInt64 && offered_v12.shaderBufferInt64Atomics;
    on.shaderInt64 = on_v12.shaderBufferInt64Atomics = features.int64_atomics;
    const VkSubgroupFeatureFlags wanted =
        VK_SUBGROUP_FEATURE_BASIC_BIT | VK_SUBGROUP_FEATURE_BALLOT_BIT | VK_SUBGROUP_FEATURE_ARITHMETIC_BIT;
    features.fragment_subgroups = (subgroups.supportedStages & VK_SHADER_STAGE_FRAGMENT_BIT) &&
                                  (subgroups.supportedOperations & wanted) == wanted;
    features.executable_properties = extension_available(device, VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME);
    if (has_conservative && conservative.degenerateTrianglesRasterized) {
        const float most = conservative.maxExtraPrimitiveOverestimationSize,
                    step = conservative.extraPrimitiveOverestimationSizeGranularity;
        const float extra = std::max(kLeastOverestimation, step);
        if (extra <= most) features.overestimation = extra;
    }
    return features;
}

}  // namespace

void check_vulkan(VkResult result, std::string_view what) {
    if (result == VK_SUCCESS) return;
    if (result == VK_ERROR_DEVICE_LOST)
        fail("the Vulkan device was lost while {}: the driver gave up; try a smaller {} or {}, or another {}", what,
             setting::size, setting::ldc, setting::device);
    if (result == VK_ERROR_OUT_OF_DEVICE_MEMORY || result == VK_ERROR_OUT_OF_HOST_MEMORY)
        throw NoRoom(
            fmt::format("out of memory while {}", what),
            fmt::format("choose a smaller {} or {}, or another {}", setting::size, setting::ldc, setting::device));
    fail("Vulkan error {} while {}", int(result), what);
}

VKAPI_ATTR VkBool32 VKAPI_CALL Device::on_message(VkDebugUtilsMessageSeverityFlagBitsEXT,
                                                  VkDebugUtilsMessageTypeFlagsEXT,
                                                  const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
    static_cast<Device*>(user)->validation_messages_.push_back(data->pMessage);
    return VK_FALSE;
}

Device::Device(const DeviceOptions& options) : state_(std::make_unique<State>()) {
    VkDebugUtilsMessengerCreateInfoEXT messenger{VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT};
    messenger.messageSeverity =
        VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    messenger.messageType =
        VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT;
    messenger.pfnUserCallback = on_message;
    messenger.pUserData = this;
    instance_ = create_instance(options.validate, &messenger, labels);
    try {
        const PhysicalDevice chosen = choose_device(instance_, options.select);
        physical = chosen.handle;
        info_ = chosen.info;
        queue_family = chosen.queue_family;
        if (options.validate && labels)
            check_vulkan(vkCreateDebugUtilsMessengerEXT(instance_, &messenger, nullptr, &messenger_),
                         "watching the validation layers");
        create_logical(options.validate);
        lower_limits(options);
    } catch (...) {
        if (messenger_) vkDestroyDebugUtilsMessengerEXT(instance_, messenger_, nullptr);
        vkDestroyInstance(instance_, nullptr);
        throw;
    }
}

void Device::create_logical(bool validate) {
    vkGetPhysicalDeviceProperties(physical, &properties_);
    vkGetPhysicalDeviceMemoryProperties(physical, &memory_);
    uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, families.data());
    timestamp_period_ = families[queue_family].timestampValidBits ? properties_.limits.timestampPeriod : 0;

    const float priority = 1;
    VkDeviceQueueCreateInfo queue_info{
        VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO, nullptr, 0, queue_family, 1, &priority};
    VkPhysicalDeviceVulkan13Features v13{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
    v13.synchronization2 = v13.dynamicRendering = v13.maintenance4 = VK_TRUE;
    VkPhysicalDeviceVulkan12Features v12{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES, &v13};
    v12.scalarBlockLayout = v12.hostQueryReset = VK_TRUE;
    VkDeviceCreateInfo info{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, &v12};
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queue_info;
    VkPhysicalDeviceFeatures optional{};
    features = optional_features(physical, optional, v12);
    info.pEnabledFeatures = &optional;
    std::vector<const char*> extensions;
    if (features.overestimation > 0) extensions.push_back(VK_EXT_CONSERVATIVE_RASTERIZATION_EXTENSION_NAME);
    RayTracingSupport ray_tracing(physical);
    ray_tracing_lacking_ = ray_tracing.lacking;
    if (ray_tracing.lacking.empty()) {
        ray_tracing_limits_ = ray_tracing.limits;
        ray_tracing.enable(features, extensions);
        v12.bufferDeviceAddress = VK_TRUE;
        v13.pNext = ray_tracing.chain();
    }
    VkPhysicalDevicePipelineExecutablePropertiesFeaturesKHR executables{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PIPELINE_EXECUTABLE_PROPERTIES_FEATURES_KHR, nullptr, VK_TRUE};
    if (features.executable_properties) {
        extensions.push_back(VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME);
        executables.pNext = v13.pNext;
        v13.pNext = &executables;
    }
    info.enabledExtensionCount = uint32_t(extensions.size());
    info.ppEnabledExtensionNames = extensions.data();
    check_vulkan(vkCreateDevice(physical, &info, nullptr, &handle), fmt::format("opening the device '{}'", info_.name));
    volkLoadDeviceTable(&vk, handle);
    vk.vkGetDeviceQueue(handle, queue_family, 0, &queue);
    immediate = properties_.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU && !validate;
    create_dummies();
    // With validation on, shaders are compiled afresh, so that the layers see every pipeline being made.
    state_->cache = std::make_unique<PipelineCache>(*this, !validate);
}

void Device::lower_limits(const DeviceOptions& options) {
    const auto lowered = [](uint64_t own, uint64_t option, uint64_t variable) {
        return std::min(own, option > 0 ? option : variable > 0 ? variable : own);
    };
    uint32_t& bound = properties_.limits.maxStorageBufferRange;
    bound = uint32_t(lowered(bound, options.most_bound, bytes_from("PEELRAY_MOST_BOUND")));
    most_held_ = lowered(~0ull, options.most_held, bytes_from("PEELRAY_MOST_HELD"));
    memory_limit_ = options.memory_limit;
    if (memory_limit_ > 0) most_held_ = std::min(most_held_, memory_limit_);
}

Device::~Device() {
    vk.vkDeviceWaitIdle(handle);
    state_.reset();
    dummy_image_.reset();
    for (VkBuffer dummy : dummies_) vk.vkDestroyBuffer(handle, dummy, nullptr);
    for (VkDeviceMemory memory : dummy_memory_) vk.vkFreeMemory(handle, memory, nullptr);
    vk.vkDestroyDevice(handle, nullptr);
    if (messenger_) vkDestroyDebugUtilsMessengerEXT(instance_, messenger_, nullptr);
    vkDestroyInstance(instance_, nullptr);
}

const Pass& Device::pass(std::string_view shader, const Constants& constants) {
    auto& entry = state_->passes[{std::string(shader), constants}];
    if (!entry) entry = std::make_unique<Pass>(*this, state_->cache->handle(), shader, constants);
    return *entry;
}

const RasterPass& Device::raster_pass(std::string_view shader, const RasterSetup& setup) {
    auto& entry = state_->raster_passes[{std::string(shader), setup}];
    if (!entry) entry = std::make_unique<RasterPass>(*this, state_->cache->handle(), shader, setup);
    return *entry;
}

const RayPass& Device::ray_pass(std::string_view shader, const RaySetup& setup) {
    auto& entry = state_->ray_passes[{std::string(shader), setup}];
    if (!entry) entry = std::make_unique<RayPass>(*this, state_->cache->handle(), shader, setup);
    return *entry;
}

void Device::check_ray_tracing() const {
    if (!features.ray_tracing)
        fail(
            "{} khr needs Vulkan's ray tracing, but the device '{}' lacks {}: use {} ldc, which does without, update "
            "its driver, or choose another {}",
            setting::tracer, info_.name, ray_tracing_lacking_, setting::tracer, setting::device);
}

void Device::check_validation() const {
    if (!validation_messages_.empty())
        fail("the Vulkan validation layers complain ({} messages); the first: {}", validation_messages_.size(),
             validation_messages_.front());
}

/// Nobody reads or writes them. They are not accounted for, since they belong to no part of the program.
void Device::create_dummies() {
    VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
    info.size = 256;
    info.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    for (size_t i = 0; i < dummies_.size(); i++) {
        check_vulkan(vk.vkCreateBuffer(handle, &info, nullptr, &dummies_[i]), "creating a dummy buffer");
        VkMemoryRequirements needs;
        vk.vkGetBufferMemoryRequirements(handle, dummies_[i], &needs);
        dummy_memory_[i] = allocate_uncounted(needs, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, 0, "a dummy buffer", false);
        check_vulkan(vk.vkBindBufferMemory(handle, dummies_[i], dummy_memory_[i], 0), "binding a dummy buffer");
    }
    dummy_image_ = std::make_unique<Image2D>(*this, "dummy", 1, 1, VK_FORMAT_R32_UINT, VK_IMAGE_USAGE_SAMPLED_BIT,
                                             VK_IMAGE_ASPECT_COLOR_BIT, 1, true);
    // An image counts its memory; nothing else has any yet.
    held_.clear();
    at_peak_.clear();
    allocated_ = peak_allocated_ = 0;
}

VkDeviceMemory Device::allocate_uncounted(const VkMemoryRequirements& needs, VkMemoryPropertyFlags wanted,
                                          VkMemoryPropertyFlags nice, std::string_view what, bool addressed) {
    int best = -1;
    for (uint32_t type = 0; type < memory_.memoryTypeCount; type++) {
        const auto flags = memory_.memoryTypes[type].propertyFlags;
        if (!(needs.memoryTypeBits >> type & 1) || (flags & wanted) != wanted) continue;
        if ((flags & nice) == nice) {
            best = int(type);
            break;
        }
        if (best < 0) best = int(type);
    }
    if (best < 0) fail("the device '{}' has no memory of the kind needed for {}", info_.name, what);
    const VkMemoryAllocateFlagsInfo flags{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO, nullptr,
                                          VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT, 0};
    VkMemoryAllocateInfo info{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, addressed ? &flags : nullptr, needs.size,
                              uint32_t(best)};
    VkDeviceMemory memory = VK_NULL_HANDLE;
    check_vulkan(vk.vkAllocateMemory(handle, &info, nullptr, &memory),
                 fmt::format("allocating {:.0f} MiB for {}", double(needs.size) / (1 << 20), what));
    return memory;
}

VkDeviceMemory Device::allocate(const VkMemoryRequirements& needs, VkMemoryPropertyFlags wanted,
                                VkMemoryPropertyFlags nice, std::string_view what, bool addressed) {
    const auto no_room = [&] {
        if (memory_limit_ > 0 && needs.size > room())
            return NoRoom(
                fmt::format("{} {} has no room for another {:.1f} MiB, {} ({:.1f} MiB are held)", setting::memory_limit,
                            memory_limit_ >> 20, double(needs.size) / (1 << 20), what, double(allocated_) / (1 << 20)),
                room_advice());
        return NoRoom(fmt::format("the memory of the device '{}' has no room for another {:.0f} MiB, {}", info_.name,
                                  double(needs.size) / (1 << 20), what),
                      room_advice());
    };
    if (needs.size > room()) throw no_room();
    VkDeviceMemory memory = VK_NULL_HANDLE;
    try {
        memory = allocate_uncounted(needs, wanted, nice, what, addressed);
    } catch (const NoRoom&) {
        throw no_room();
    }
    allocated_ += needs.size;
    held_.push_back({memory, {part_, std::string(what), needs.size}});
    if (allocated_ > peak_allocated_) reset_peak();
    return memory;
}

void Device::release(VkDeviceMemory memory, uint64_t size) {
    vk.vkFreeMemory(handle, memory, nullptr);
    allocated_ -= size;
    std::erase_if(held_, [&](const auto& entry) { return entry.first == memory; });
}

uint64_t Device::staging_bytes() const {
    constexpr uint64_t usual = 64ull << 20, least = 1ull << 16;
    return most_held_ == ~0ull ? usual : std::clamp<uint64_t>(most_held_ / 64 & ~0xffull, least, usual);
}

std::string Device::room_advice() const {
    const std::string_view part = part_;
    if (memory_limit_ > 0) {
        const std::string more = fmt::format("raise {}, or ", setting::memory_limit);
        if (part == "frame" || part == "images") return more + fmt::format("choose a smaller {}", setting::size);
        if (part == "cubes" || part == "build scratch") return more + fmt::format("use a smaller {}", setting::ldc);
        return more + fmt::format("use {} cpu, which needs none", setting::tracer);
    }
    if (part == "frame" || part == "images")
        return fmt::format("choose a smaller {}, or another {}", setting::size, setting::device);
    if (part == "cubes" || part == "build scratch")
        return fmt::format("use a smaller {}, or another {}", setting::ldc, setting::device);
    return fmt::format("choose another {}, or {} reference, which renders without one", setting::device,
                       setting::tracer);
}

std::vector<Allocation> Device::allocations() const {
    std::vector<Allocation> list;
    for (const auto& [memory, allocation] : held_) list.push_back(allocation);
    return list;
}

void Device::reset_peak() {
    peak_allocated_ = allocated_;
    at_peak_ = allocations();
}

}  // namespace peelray
