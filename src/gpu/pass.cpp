#include "gpu/pass.h"

#include <algorithm>
#include <cassert>
#include <spirv_cross/spirv_cross.hpp>

#include "base/error.h"

namespace peelray {
namespace {

std::vector<EmbeddedShader>& registered() {
    static std::vector<EmbeddedShader> shaders(peelray_shaders().begin(), peelray_shaders().end());
    return shaders;
}

std::span<const uint32_t> find_shader(std::string_view name) {
    for (const auto& shader : registered())
        if (shader.name == name) return shader.code;
    fail("no shader '{}' is built in (a programming error)", name);
}

}  // namespace

void register_shaders(std::span<const EmbeddedShader> shaders) {
    registered().insert(registered().end(), shaders.begin(), shaders.end());
}

void ShaderInterface::reflect(std::span<const uint32_t> code) {
    const spirv_cross::Compiler compiler(std::vector<uint32_t>(code.begin(), code.end()));
    const auto resources = compiler.get_shader_resources();
    for (const auto& resource : resources.storage_buffers) {
        std::string name = resource.name;
        const std::string suffix = "_block";
        if (name.size() > suffix.size() && name.ends_with(suffix)) name.resize(name.size() - suffix.size());
        const auto flags = compiler.get_buffer_block_flags(resource.id);
        const ShaderBinding found{name, compiler.get_decoration(resource.id, spv::DecorationBinding),
                                  !flags.get(spv::DecorationNonReadable), !flags.get(spv::DecorationNonWritable)};
        auto same =
            std::find_if(bindings.begin(), bindings.end(), [&](auto& other) { return other.binding == found.binding; });
        if (same == bindings.end()) {
            bindings.push_back(found);
        } else {
            assert(same->name == found.name);
            same->reads |= found.reads;
            same->writes |= found.writes;
        }
    }
    for (const auto& resource : resources.push_constant_buffers) {
        const auto size = compiler.get_declared_struct_size(compiler.get_type(resource.base_type_id));
        push_constant_bytes = std::max(push_constant_bytes, uint32_t(size));
    }
    for (uint32_t axis = 0; axis < 3; axis++)
        group_size[axis] = std::max(1u, compiler.get_execution_mode_argument(spv::ExecutionModeLocalSize, axis));
}

bool ShaderInterface::declares(std::string_view name) const {
    return std::any_of(bindings.begin(), bindings.end(), [&](const auto& binding) { return binding.name == name; });
}

PassBase::~PassBase() {
    device_.vk.vkDestroyPipeline(device_.handle, pipeline_, nullptr);
    device_.vk.vkDestroyPipelineLayout(device_.handle, layout_, nullptr);
    device_.vk.vkDestroyDescriptorSetLayout(device_.handle, set_layout_, nullptr);
}

VkShaderModule PassBase::create_module(std::span<const uint32_t> code) {
    interface_.reflect(code);
    VkShaderModuleCreateInfo info{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO, nullptr, 0, code.size_bytes(),
                                  code.data()};
    VkShaderModule module = VK_NULL_HANDLE;
    check_vulkan(device_.vk.vkCreateShaderModule(device_.handle, &info, nullptr, &module),
                 "loading the shader " + name_);
    return module;
}

void PassBase::create_layout() {
    std::vector<VkDescriptorSetLayoutBinding> bindings;
    for (const auto& binding : interface_.bindings)
        bindings.push_back({binding.binding, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, stages_, nullptr});
    VkDescriptorSetLayoutCreateInfo set_info{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
    set_info.bindingCount = uint32_t(bindings.size());
    set_info.pBindings = bindings.data();
    check_vulkan(device_.vk.vkCreateDescriptorSetLayout(device_.handle, &set_info, nullptr, &set_layout_),
                 "laying out " + name_);

    const VkPushConstantRange range{stages_, 0, interface_.push_constant_bytes};
    VkPipelineLayoutCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
    info.setLayoutCount = 1;
    info.pSetLayouts = &set_layout_;
    info.pushConstantRangeCount = interface_.push_constant_bytes ? 1 : 0;
    info.pPushConstantRanges = &range;
    check_vulkan(device_.vk.vkCreatePipelineLayout(device_.handle, &info, nullptr, &layout_), "laying out " + name_);
}

Pass::Pass(Device& device, VkPipelineCache cache, std::string_view shader, const std::vector<uint32_t>& constants)
    : PassBase(device, std::string(shader)) {
    stages_ = VK_SHADER_STAGE_COMPUTE_BIT;
    VkShaderModule module = create_module(find_shader(shader));
    create_layout();

    std::vector<VkSpecializationMapEntry> entries;
    for (uint32_t i = 0; i < constants.size(); i++) entries.push_back({i, i * 4, 4});
    const VkSpecializationInfo specialization{uint32_t(entries.size()), entries.data(), constants.size() * 4,
                                              constants.data()};
    VkComputePipelineCreateInfo info{VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
    info.stage = {
        VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO, nullptr, 0, VK_SHADER_STAGE_COMPUTE_BIT, module, "main",
        constants.empty() ? nullptr : &specialization};
    info.layout = layout_;
    const VkResult result = device.vk.vkCreateComputePipelines(device.handle, cache, 1, &info, nullptr, &pipeline_);
    device.vk.vkDestroyShaderModule(device.handle, module, nullptr);
    check_vulkan(result, "compiling the shader " + name_);
}

RasterPass::RasterPass(Device& device, VkPipelineCache cache, std::string_view shader, std::string_view fragment_shader)
    : PassBase(device, std::string(shader)) {
    stages_ = VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT;
    VkShaderModule vertex = create_module(find_shader(name_ + ".vert"));
    VkShaderModule fragment = create_module(find_shader(std::string(fragment_shader) + ".frag"));
    create_layout();

    const VkPipelineShaderStageCreateInfo stage_infos[] = {
        {VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO, nullptr, 0, VK_SHADER_STAGE_VERTEX_BIT, vertex, "main",
         nullptr},
        {VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO, nullptr, 0, VK_SHADER_STAGE_FRAGMENT_BIT, fragment,
         "main", nullptr}};
    VkPipelineVertexInputStateCreateInfo input{VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
    VkPipelineInputAssemblyStateCreateInfo assembly{VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO};
    assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
    VkPipelineViewportStateCreateInfo viewport{VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO};
    viewport.viewportCount = viewport.scissorCount = 1;
    VkPipelineRasterizationStateCreateInfo raster{VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO};
    raster.cullMode = VK_CULL_MODE_NONE;
    raster.lineWidth = 1;
    VkPipelineMultisampleStateCreateInfo multisample{VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO};
    multisample.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
    VkPipelineDepthStencilStateCreateInfo depth{VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO};
    depth.depthTestEnable = depth.depthWriteEnable = VK_TRUE;
    depth.depthCompareOp = VK_COMPARE_OP_GREATER;  // reversed depth: precise far away
    VkPipelineColorBlendAttachmentState attachment{};
    attachment.colorWriteMask = VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT;
    VkPipelineColorBlendStateCreateInfo blend{VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO};
    blend.attachmentCount = 1;
    blend.pAttachments = &attachment;
    const VkDynamicState states[] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
    VkPipelineDynamicStateCreateInfo dynamic{VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO, nullptr, 0, 2,
                                             states};
    const VkFormat color = VK_FORMAT_R32G32_UINT;
    VkPipelineRenderingCreateInfo rendering{VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO};
    rendering.colorAttachmentCount = 1;
    rendering.pColorAttachmentFormats = &color;
    rendering.depthAttachmentFormat = VK_FORMAT_D32_SFLOAT;

    VkGraphicsPipelineCreateInfo info{VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO, &rendering};
    info.stageCount = 2;
    info.pStages = stage_infos;
    info.pVertexInputState = &input;
    info.pInputAssemblyState = &assembly;
    info.pViewportState = &viewport;
    info.pRasterizationState = &raster;
    info.pMultisampleState = &multisample;
    info.pDepthStencilState = &depth;
    info.pColorBlendState = &blend;
    info.pDynamicState = &dynamic;
    info.layout = layout_;
    const VkResult result = device.vk.vkCreateGraphicsPipelines(device.handle, cache, 1, &info, nullptr, &pipeline_);
    device.vk.vkDestroyShaderModule(device.handle, vertex, nullptr);
    device.vk.vkDestroyShaderModule(device.handle, fragment, nullptr);
    check_vulkan(result, "compiling the shader " + name_);
}

}  // namespace peelray
