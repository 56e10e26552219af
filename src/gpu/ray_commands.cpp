// What Commands records of the device's ray tracing.
#include <algorithm>

#include "base/error.h"
#include "gpu/commands.h"

namespace peelray {
namespace {

constexpr VkPipelineStageFlags2 kRays =
    VK_PIPELINE_STAGE_2_RAY_TRACING_SHADER_BIT_KHR | VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT;
constexpr VkPipelineStageFlags2 kBuild = VK_PIPELINE_STAGE_2_ACCELERATION_STRUCTURE_BUILD_BIT_KHR;

}  // namespace

void Commands::record_rays(const RayPass& pass, std::span<const Binding> bindings, const void* params, size_t bytes,
                           uint32_t rays, const Buffer* arguments, uint64_t offset) {
    check_params(pass, bytes);
    if (rays > device_.ray_tracing_limits().most_rays)
        fail("the pass {} starts {} rays, more than the {} that the device '{}' takes: use a smaller {}", pass.name(),
             rays, device_.ray_tracing_limits().most_rays, device_.info().name, setting::size);
    const VkDescriptorSet set = prepare(pass, bindings, arguments, kRays);
    start(pass, VK_PIPELINE_BIND_POINT_RAY_TRACING_KHR, set, params, bytes);
    const VkStridedDeviceAddressRegionKHR none{};
    if (arguments)
        device_.vk.vkCmdTraceRaysIndirectKHR(commands_, &pass.generation(), &pass.misses(), &pass.hits(), &none,
                                             arguments->address() + offset);
    else if (rays > 0)
        device_.vk.vkCmdTraceRaysKHR(commands_, &pass.generation(), &pass.misses(), &pass.hits(), &none, rays, 1, 1);
    finish();
}

void Commands::build(const std::string& name, std::span<const StructureBuild> builds, const Buffer& scratch) {
    begin();
    bool hazard = false;
    touch(scratch, false, true, hazard);
    for (const StructureBuild& build : builds) {
        touch(build.structure.storage(), build.update, true, hazard);
        for (const Buffer* input : build.source.inputs()) touch(*input, true, false, hazard);
    }
    barrier_if(hazard, kBuild);
    access(scratch).written = true;
    for (const StructureBuild& build : builds) {
        access(build.structure.storage()).written = true;
        for (const Buffer* input : build.source.inputs()) access(*input).read = true;
    }

    const uint64_t alignment = device_.ray_tracing_limits().scratch_alignment;
    const VkDeviceAddress first = (scratch.address() + alignment - 1) / alignment * alignment;
    std::vector<VkAccelerationStructureBuildGeometryInfoKHR> infos;
    std::vector<const VkAccelerationStructureBuildRangeInfoKHR*> ranges;
    for (const StructureBuild& build : builds) {
        infos.push_back(build.source.info(build.flags));
        infos.back().dstAccelerationStructure = build.structure.handle();
        infos.back().scratchData.deviceAddress = first + build.scratch_offset;
        ranges.push_back(build.source.ranges());
        if (!build.update) continue;
        infos.back().mode = VK_BUILD_ACCELERATION_STRUCTURE_MODE_UPDATE_KHR;
        infos.back().srcAccelerationStructure = build.structure.handle();
    }
    label(name);
    begin_timer(name);
    device_.vk.vkCmdBuildAccelerationStructuresKHR(commands_, uint32_t(infos.size()), infos.data(), ranges.data());
    end_timer();
    end_label();
}

std::vector<uint64_t> Commands::compacted_bytes(std::span<const AccelerationStructure> structures) {
    submit();
    std::vector<VkAccelerationStructureKHR> handles;
    for (const AccelerationStructure& structure : structures) handles.push_back(structure.handle());
    VkQueryPoolCreateInfo info{VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO};
    info.queryType = VK_QUERY_TYPE_ACCELERATION_STRUCTURE_COMPACTED_SIZE_KHR;
    info.queryCount = uint32_t(handles.size());
    VkQueryPool pool = VK_NULL_HANDLE;
    check_vulkan(device_.vk.vkCreateQueryPool(device_.handle, &info, nullptr, &pool), "creating a query pool");
    begin();
    device_.vk.vkResetQueryPool(device_.handle, pool, 0, info.queryCount);
    device_.vk.vkCmdWriteAccelerationStructuresPropertiesKHR(commands_, info.queryCount, handles.data(), info.queryType,
                                                             pool, 0);
    flush();
    std::vector<uint64_t> bytes(handles.size());
    const VkResult result =
        device_.vk.vkGetQueryPoolResults(device_.handle, pool, 0, info.queryCount, bytes.size() * 8, bytes.data(), 8,
                                         VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT);
    device_.vk.vkDestroyQueryPool(device_.handle, pool, nullptr);
    check_vulkan(result, "reading the sizes of acceleration structures");
    return bytes;
}

void Commands::compact(const std::string& name, std::span<const AccelerationStructure> from,
                       std::span<const AccelerationStructure> to) {
    begin();
    bool hazard = false;
    for (const AccelerationStructure& structure : from) touch(structure.storage(), true, false, hazard);
    for (const AccelerationStructure& structure : to) touch(structure.storage(), false, true, hazard);
    barrier_if(hazard, kBuild);
    for (const AccelerationStructure& structure : from) access(structure.storage()).read = true;
    for (const AccelerationStructure& structure : to) access(structure.storage()).written = true;
    label(name);
    begin_timer(name);
    for (size_t i = 0; i < from.size(); i++) {
        VkCopyAccelerationStructureInfoKHR info{VK_STRUCTURE_TYPE_COPY_ACCELERATION_STRUCTURE_INFO_KHR};
        info.src = from[i].handle();
        info.dst = to[i].handle();
        info.mode = VK_COPY_ACCELERATION_STRUCTURE_MODE_COMPACT_KHR;
        device_.vk.vkCmdCopyAccelerationStructureKHR(commands_, &info);
    }
    end_timer();
    end_label();
}

}  // namespace peelray
