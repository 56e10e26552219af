// The Vulkan instance and the choice among physical devices. Private to src/gpu.
#pragma once

#include "gpu/device.h"

namespace peelray {

/// Creates an instance; `validate` asks for the Khronos layer and throws Error where it is not installed.
VkInstance create_instance(bool validate, const VkDebugUtilsMessengerCreateInfoEXT* messenger, bool& debug_utils);

/// A physical device and what is known of it.
struct PhysicalDevice {
    VkPhysicalDevice handle;
    DeviceInfo info;
    uint32_t queue_family;
};

/// Best first: discrete, integrated, virtual, CPU; indices numbered in that order. Throws Error if there is none.
std::vector<PhysicalDevice> physical_devices(VkInstance instance);

/// The device that `select` names (see DeviceOptions). Throws Error listing what there is.
PhysicalDevice choose_device(VkInstance instance, const std::string& select);

}  // namespace peelray
