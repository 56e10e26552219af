// What a machine lacks, each with what to do about it.
#pragma once

#include <string>
#include <vector>

#include "doctor/surroundings.h"
#include "gpu/device.h"

namespace peelray {

/// A cause, as a line: what is so, and what to do.
struct Finding {
    std::string cause;  ///< its name, see find_causes()
    std::string what, remedy;

    std::string line() const { return what + ": " + remedy; }
};

/// What Vulkan says of itself.
struct VulkanState {
    bool loader = false;  ///< its library is there
    std::vector<DeviceInfo> devices;
};
VulkanState vulkan_state();

/// The causes, those that keep a GPU from being used first:
///   no-loader             Vulkan's loader is not installed
///   no-driver-file        no file tells the loader of a driver
///   driver-not-loadable   one does, but its library cannot be loaded
///   container-capability  a container has NVIDIA's driver without its graphics part
///   no-vulkan-library     NVIDIA's driver is loaded, but its graphics part is not installed
///   split-gpu             a slice of a GPU (MIG), which has no Vulkan
///   no-permission         the device's file may not be used
///   no-device-file        a GPU on the bus without a device's file
///   no-device             there are drivers, but they find none
///   old-vulkan            a device's Vulkan is older than 1.3
///   missing-feature       a device lacks a feature
///   software-only         no device but the CPU
///   little-memory         less than a GiB, of a GPU or of the machine
///   cache                 compiled shaders cannot be kept
///   no-ffmpeg             no videos
std::vector<Finding> find_causes(const Surroundings& around, const VulkanState& vulkan);

}  // namespace peelray
