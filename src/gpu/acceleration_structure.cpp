#include "gpu/acceleration_structure.h"

#include <utility>

#include "base/error.h"

namespace peelray {

AccelerationStructure::AccelerationStructure(Device& device, const Buffer& storage, uint64_t offset, uint64_t bytes,
                                             VkAccelerationStructureTypeKHR type)
    : device_(&device), storage_(&storage) {
    VkAccelerationStructureCreateInfoKHR info{VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_CREATE_INFO_KHR};
    info.buffer = storage.handle();
    info.offset = offset;
    info.size = bytes;
    info.type = type;
    check_vulkan(device.vk.vkCreateAccelerationStructureKHR(device.handle, &info, nullptr, &handle_),
                 "creating an acceleration structure in " + storage.name());
}

AccelerationStructure& AccelerationStructure::operator=(AccelerationStructure&& other) noexcept {
    if (this == &other) return *this;
    reset();
    device_ = std::exchange(other.device_, nullptr);
    storage_ = std::exchange(other.storage_, nullptr);
    handle_ = std::exchange(other.handle_, VkAccelerationStructureKHR(VK_NULL_HANDLE));
    shown = std::exchange(other.shown, {});
    return *this;
}

void AccelerationStructure::reset() {
    if (handle_) device_->vk.vkDestroyAccelerationStructureKHR(device_->handle, handle_, nullptr);
    handle_ = VK_NULL_HANDLE;
}

VkDeviceAddress AccelerationStructure::address() const {
    const VkAccelerationStructureDeviceAddressInfoKHR info{
        VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_DEVICE_ADDRESS_INFO_KHR, nullptr, handle_};
    return device_->vk.vkGetAccelerationStructureDeviceAddressKHR(device_->handle, &info);
}

void StructureSource::add_triangles(const Buffer& positions, const Buffer& triangles, uint32_t first, uint32_t count,
                                    uint32_t last_vertex, bool opaque) {
    VkAccelerationStructureGeometryKHR geometry{VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR};
    geometry.geometryType = VK_GEOMETRY_TYPE_TRIANGLES_KHR;
    geometry.flags = opaque ? VK_GEOMETRY_OPAQUE_BIT_KHR : 0;
    auto& data = geometry.geometry.triangles;
    data.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_TRIANGLES_DATA_KHR;
    data.vertexFormat = VK_FORMAT_R32G32B32_SFLOAT;
    data.vertexData.deviceAddress = positions.address();
    data.vertexStride = 12;
    data.maxVertex = last_vertex;
    data.indexType = VK_INDEX_TYPE_UINT32;
    data.indexData.deviceAddress = triangles.address();
    geometries_.push_back(geometry);
    ranges_.push_back({count, first * 12, 0, 0});
    counts_.push_back(count);
    inputs_ = {&positions, &triangles};
}

void StructureSource::set_instances(const Buffer& instances, uint32_t count, std::vector<const Buffer*> shown) {
    type_ = VK_ACCELERATION_STRUCTURE_TYPE_TOP_LEVEL_KHR;
    VkAccelerationStructureGeometryKHR geometry{VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR};
    geometry.geometryType = VK_GEOMETRY_TYPE_INSTANCES_KHR;
    auto& data = geometry.geometry.instances;
    data.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_INSTANCES_DATA_KHR;
    data.data.deviceAddress = instances.address();
    geometries_ = {geometry};
    ranges_ = {{count, 0, 0, 0}};
    counts_ = {count};
    inputs_ = std::move(shown);
    inputs_.push_back(&instances);
}

VkAccelerationStructureBuildGeometryInfoKHR StructureSource::info(VkBuildAccelerationStructureFlagsKHR flags) const {
    VkAccelerationStructureBuildGeometryInfoKHR info{VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_GEOMETRY_INFO_KHR};
    info.type = type_;
    info.flags = flags;
    info.mode = VK_BUILD_ACCELERATION_STRUCTURE_MODE_BUILD_KHR;
    info.geometryCount = uint32_t(geometries_.size());
    info.pGeometries = geometries_.data();
    return info;
}

StructureSizes sizes_of(Device& device, const StructureSource& source, VkBuildAccelerationStructureFlagsKHR flags) {
    const RayTracingLimits& limits = device.ray_tracing_limits();
    uint64_t primitives = 0;
    for (uint32_t count : source.counts()) primitives += count;
    const bool top = source.type() == VK_ACCELERATION_STRUCTURE_TYPE_TOP_LEVEL_KHR;
    const uint64_t most = top ? limits.most_instances : limits.most_triangles;
    if (primitives > most)
        fail("{} {} are more than the {} that the device '{}' traces: use {} ldc", primitives,
             top ? "instances" : "triangles of one object", most, device.info().name, setting::tracer);
    const auto info = source.info(flags);
    VkAccelerationStructureBuildSizesInfoKHR sizes{VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_SIZES_INFO_KHR};
    device.vk.vkGetAccelerationStructureBuildSizesKHR(device.handle, VK_ACCELERATION_STRUCTURE_BUILD_TYPE_DEVICE_KHR,
                                                      &info, source.counts().data(), &sizes);
    return {sizes.accelerationStructureSize, sizes.buildScratchSize, sizes.updateScratchSize};
}

}  // namespace peelray
