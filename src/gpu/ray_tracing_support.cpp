#include "gpu/ray_tracing_support.h"

#include <algorithm>

namespace peelray {
namespace {

const char* const kExtensions[] = {VK_KHR_ACCELERATION_STRUCTURE_EXTENSION_NAME,
                                   VK_KHR_RAY_TRACING_PIPELINE_EXTENSION_NAME,
                                   VK_KHR_DEFERRED_HOST_OPERATIONS_EXTENSION_NAME};

}  // namespace

RayTracingSupport::RayTracingSupport(VkPhysicalDevice device) {
    for (const char* name : kExtensions)
        if (!extension_available(device, name)) {
            lacking = name;
            return;
        }
    VkPhysicalDeviceVulkan12Features v12{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES, &pipelines_};
    structures_.pNext = &v12;
    VkPhysicalDeviceFeatures2 offered{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &structures_};
    vkGetPhysicalDeviceFeatures2(device, &offered);
    if (!structures_.accelerationStructure) lacking = "accelerationStructure";
    if (!pipelines_.rayTracingPipeline) lacking = "rayTracingPipeline";
    if (!v12.bufferDeviceAddress) lacking = "bufferDeviceAddress";

    VkPhysicalDeviceAccelerationStructurePropertiesKHR structure{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_PROPERTIES_KHR};
    VkPhysicalDeviceRayTracingPipelinePropertiesKHR pipeline{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_TRACING_PIPELINE_PROPERTIES_KHR, &structure};
    VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &pipeline};
    vkGetPhysicalDeviceProperties2(device, &properties);
    limits = {
        pipeline.shaderGroupHandleSize,        pipeline.shaderGroupHandleAlignment,
        pipeline.shaderGroupBaseAlignment,     std::max(structure.minAccelerationStructureScratchOffsetAlignment, 1u),
        structure.maxPrimitiveCount,           structure.maxInstanceCount,
        pipeline.maxRayDispatchInvocationCount};

    // Nothing else of what is offered is turned on.
    const VkBool32 indirect = pipelines_.rayTracingPipelineTraceRaysIndirect,
                   skips_boxes = pipelines_.rayTraversalPrimitiveCulling;
    pipelines_ = {VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_TRACING_PIPELINE_FEATURES_KHR};
    structures_ = {VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_FEATURES_KHR};
    pipelines_.rayTracingPipeline = structures_.accelerationStructure = VK_TRUE;
    pipelines_.rayTracingPipelineTraceRaysIndirect = indirect;
    pipelines_.rayTraversalPrimitiveCulling = skips_boxes;
}

void RayTracingSupport::enable(DeviceFeatures& features, std::vector<const char*>& extensions) {
    features.ray_tracing = true;
    features.indirect_rays = pipelines_.rayTracingPipelineTraceRaysIndirect == VK_TRUE;
    features.skips_boxes = pipelines_.rayTraversalPrimitiveCulling == VK_TRUE;
    extensions.insert(extensions.end(), std::begin(kExtensions), std::end(kExtensions));
    structures_.pNext = &pipelines_;
}

}  // namespace peelray
