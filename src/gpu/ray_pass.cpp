#include "gpu/ray_pass.h"

#include "gpu/commands.h"

namespace peelray {
namespace {

constexpr uint32_t kGroups = 3;  // ray generation, misses, hits

uint64_t round_up(uint64_t value, uint64_t to) {
    return (value + to - 1) / to * to;
}

}  // namespace

RayPass::RayPass(Device& device, VkPipelineCache cache, std::string_view shader, const RaySetup& setup)
    : PassBase(device, std::string(shader)) {
    const std::string rays = setup.rays.empty() ? name_ : setup.rays;
    VkRayTracingShaderGroupCreateInfoKHR groups[kGroups];
    for (auto& group : groups) {
        group = {VK_STRUCTURE_TYPE_RAY_TRACING_SHADER_GROUP_CREATE_INFO_KHR};
        group.type = VK_RAY_TRACING_SHADER_GROUP_TYPE_GENERAL_KHR;
        group.generalShader = group.closestHitShader = group.anyHitShader = group.intersectionShader =
            VK_SHADER_UNUSED_KHR;
    }
    groups[0].generalShader = add_stage(VK_SHADER_STAGE_RAYGEN_BIT_KHR, name_ + ".rgen");
    groups[1].generalShader = add_stage(VK_SHADER_STAGE_MISS_BIT_KHR, rays + ".rmiss");
    groups[2].type = VK_RAY_TRACING_SHADER_GROUP_TYPE_TRIANGLES_HIT_GROUP_KHR;
    if (setup.nearest) groups[2].closestHitShader = add_stage(VK_SHADER_STAGE_CLOSEST_HIT_BIT_KHR, rays + ".rchit");
    if (setup.any) groups[2].anyHitShader = add_stage(VK_SHADER_STAGE_ANY_HIT_BIT_KHR, rays + ".rahit");
    const auto stages = create_stages(setup.constants);

    VkRayTracingPipelineCreateInfoKHR info{VK_STRUCTURE_TYPE_RAY_TRACING_PIPELINE_CREATE_INFO_KHR};
    info.flags = VK_PIPELINE_CREATE_RAY_TRACING_NO_NULL_MISS_SHADERS_BIT_KHR;
    if (setup.nearest) info.flags |= VK_PIPELINE_CREATE_RAY_TRACING_NO_NULL_CLOSEST_HIT_SHADERS_BIT_KHR;
    if (setup.any) info.flags |= VK_PIPELINE_CREATE_RAY_TRACING_NO_NULL_ANY_HIT_SHADERS_BIT_KHR;
    if (device.features.skips_boxes) info.flags |= VK_PIPELINE_CREATE_RAY_TRACING_SKIP_AABBS_BIT_KHR;
    info.stageCount = uint32_t(stages.size());
    info.pStages = stages.data();
    info.groupCount = kGroups;
    info.pGroups = groups;
    info.maxPipelineRayRecursionDepth = 1;
    info.layout = layout_;
    const VkResult result =
        device.vk.vkCreateRayTracingPipelinesKHR(device.handle, VK_NULL_HANDLE, cache, 1, &info, nullptr, &pipeline_);
    destroy_modules(stages);
    check_vulkan(result, "compiling the shader " + name_);
    create_table();
}

void RayPass::create_table() {
    const RayTracingLimits& limits = device_.ray_tracing_limits();
    const uint64_t record = round_up(round_up(limits.handle_bytes, limits.handle_alignment), limits.table_alignment);
    std::vector<std::byte> handles(size_t(limits.handle_bytes) * kGroups), records(record * kGroups);
    check_vulkan(device_.vk.vkGetRayTracingShaderGroupHandlesKHR(device_.handle, pipeline_, 0, kGroups, handles.size(),
                                                                 handles.data()),
                 "reading the shader groups of " + name_);
    for (uint32_t i = 0; i < kGroups; i++)
        std::memcpy(&records[i * record], &handles[size_t(i) * limits.handle_bytes], limits.handle_bytes);
    table_ = Buffer(device_, "shader binding table of " + name_, records.size() + limits.table_alignment,
                    Buffer::Where::ray_tracing);
    const VkDeviceAddress first = round_up(table_.address(), limits.table_alignment);
    for (uint32_t i = 0; i < kGroups; i++) regions_[i] = {first + i * record, record, record};
    Commands commands(device_);
    commands.upload(table_, std::span<const std::byte>(records), first - table_.address());
}

}  // namespace peelray
