// What a physical device offers of Vulkan's ray tracing. Private to src/gpu.
#pragma once

#include "gpu/device.h"

namespace peelray {

bool extension_available(VkPhysicalDevice device, const char* name);

/// Queries a device, and then enables the features that are used.
struct RayTracingSupport {
    explicit RayTracingSupport(VkPhysicalDevice device);

    std::string lacking;  ///< what is missing; empty: rays can be traced
    RayTracingLimits limits;

    void enable(DeviceFeatures& features, std::vector<const char*>& extensions);
    /// For VkDeviceCreateInfo; valid as long as this stays where it is.
    void* chain() { return &structures_; }

  private:
    VkPhysicalDeviceRayTracingPipelineFeaturesKHR pipelines_{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_TRACING_PIPELINE_FEATURES_KHR};
    VkPhysicalDeviceAccelerationStructureFeaturesKHR structures_{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_FEATURES_KHR};
};

}  // namespace peelray
