#include "gpu/pass.h"

#include <algorithm>
#include <spirv_cross/spirv_cross.hpp>

#include "base/error.h"
#include "gpu/specialize.h"

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

std::map<uint32_t, uint32_t> numbered(std::string_view pass, const ShaderInterface& interface,
                                      const Constants& constants) {
    const auto with_name = [](std::string_view name) {
        return [=](const auto& constant) { return constant.name == name; };
    };
    for (const Constant& given : constants) {
        if (std::ranges::none_of(interface.constants, with_name(given.name)))
            fail("the pass {} has no constant '{}' (a programming error)", pass, given.name);
        if (std::ranges::count_if(constants, with_name(given.name)) > 1)
            fail("the pass {} was given the constant '{}' twice (a programming error)", pass, given.name);
    }
    std::map<uint32_t, uint32_t> values;
    for (const ShaderConstant& wanted : interface.constants) {
        const auto given = std::ranges::find_if(constants, with_name(wanted.name));
        if (given == constants.end())
            fail("the pass {} was not given the constant '{}' (a programming error)", pass, wanted.name);
        values[wanted.id] = given->value;
    }
    return values;
}

void register_shaders(std::span<const EmbeddedShader> shaders) {
    registered().insert(registered().end(), shaders.begin(), shaders.end());
}

void ShaderInterface::add(const ShaderBinding& found) {
    const auto same =
        std::find_if(bindings.begin(), bindings.end(), [&](auto& other) { return other.binding == found.binding; });
    if (same == bindings.end()) return bindings.push_back(found);
    if (same->name != found.name || same->image != found.image || same->structure != found.structure)
        fail("two stages disagree on binding {}: '{}' and '{}' (a programming error)", found.binding, same->name,
             found.name);
    same->reads |= found.reads;
    same->writes |= found.writes;
}

void ShaderInterface::add(const ShaderConstant& found) {
    for (const ShaderConstant& other : constants) {
        if (other.name == found.name && other.id == found.id) return;
        if (other.name == found.name || other.id == found.id)
            fail("two stages disagree on a constant: '{}' is number {} and '{}' number {} (a programming error)",
                 other.name, other.id, found.name, found.id);
    }
    constants.push_back(found);
}

void ShaderInterface::reflect(std::span<const uint32_t> code) {
    const spirv_cross::Compiler compiler(std::vector<uint32_t>(code.begin(), code.end()));
    const auto resources = compiler.get_shader_resources();
    for (const auto& resource : resources.storage_buffers) {
        std::string name = resource.name;
        const std::string suffix = "_block";
        if (name.size() > suffix.size() && name.ends_with(suffix)) name.resize(name.size() - suffix.size());
        const auto flags = compiler.get_buffer_block_flags(resource.id);
        add(ShaderBinding{name, compiler.get_decoration(resource.id, spv::DecorationBinding),
                          !flags.get(spv::DecorationNonReadable), !flags.get(spv::DecorationNonWritable)});
    }
    for (const auto& image : resources.separate_images)
        add(ShaderBinding{image.name, compiler.get_decoration(image.id, spv::DecorationBinding), true, false, true});
    for (const auto& structure : resources.acceleration_structures)
        add(ShaderBinding{structure.name, compiler.get_decoration(structure.id, spv::DecorationBinding), true, false,
                          false, true});
    for (const auto& constant : compiler.get_specialization_constants())
        add(ShaderConstant{compiler.get_name(constant.id), constant.constant_id});
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

uint32_t PassBase::add_stage(VkShaderStageFlagBits bit, std::string_view shader) {
    const std::span<const uint32_t> code = find_shader(shader);
    interface_.reflect(code);
    stages_ |= bit;
    added_.push_back({bit, code});
    return uint32_t(added_.size() - 1);
}

std::vector<VkPipelineShaderStageCreateInfo> PassBase::create_stages(const Constants& constants) {
    const auto values = numbered(name_, interface_, constants);
    create_layout();
    std::vector<VkPipelineShaderStageCreateInfo> stages;
    for (const Stage& stage : added_) {
        const std::vector<uint32_t> code = specialize(stage.code, values);
        const VkShaderModuleCreateInfo info{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO, nullptr, 0,
                                            code.size() * sizeof(uint32_t), code.data()};
        VkShaderModule module = VK_NULL_HANDLE;
        const VkResult result = device_.vk.vkCreateShaderModule(device_.handle, &info, nullptr, &module);
        if (result != VK_SUCCESS) destroy_modules(stages);
        check_vulkan(result, "loading the shader " + name_);
        stages.push_back({VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO, nullptr, 0, stage.bit, module, "main"});
    }
    return stages;
}

void PassBase::destroy_modules(std::span<const VkPipelineShaderStageCreateInfo> stages) {
    for (const auto& stage : stages) device_.vk.vkDestroyShaderModule(device_.handle, stage.module, nullptr);
}

void PassBase::create_layout() {
    std::vector<VkDescriptorSetLayoutBinding> bindings;
    for (const auto& binding : interface_.bindings)
        bindings.push_back({binding.binding, descriptor_type(binding), 1, stages_, nullptr});
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

Pass::Pass(Device& device, VkPipelineCache cache, std::string_view shader, const Constants& constants)
    : PassBase(device, std::string(shader)) {
    add_stage(VK_SHADER_STAGE_COMPUTE_BIT, shader);
    const auto stages = create_stages(constants);
    VkComputePipelineCreateInfo info{VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
    info.stage = stages[0];
    info.layout = layout_;
    if (device.features.executable_properties) info.flags = VK_PIPELINE_CREATE_CAPTURE_STATISTICS_BIT_KHR;
    const VkResult result = device.vk.vkCreateComputePipelines(device.handle, cache, 1, &info, nullptr, &pipeline_);
    destroy_modules(stages);
    check_vulkan(result, "compiling the shader " + name_);
}

std::vector<std::pair<std::string, double>> Pass::statistics() const {
    std::vector<std::pair<std::string, double>> found;
    if (!device_.features.executable_properties) return found;
    const VkPipelineExecutableInfoKHR executable{VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_INFO_KHR, nullptr, pipeline_, 0};
    uint32_t count = 0;
    const auto get = device_.vk.vkGetPipelineExecutableStatisticsKHR;
    if (get(device_.handle, &executable, &count, nullptr) != VK_SUCCESS) return found;
    std::vector<VkPipelineExecutableStatisticKHR> all(count, {VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_STATISTIC_KHR});
    get(device_.handle, &executable, &count, all.data());
    for (const VkPipelineExecutableStatisticKHR& one : all) {
        const auto& value = one.value;
        switch (one.format) {
            case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_BOOL32_KHR:
                found.emplace_back(one.name, value.b32);
                break;
            case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_INT64_KHR:
                found.emplace_back(one.name, double(value.i64));
                break;
            case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_UINT64_KHR:
                found.emplace_back(one.name, double(value.u64));
                break;
            default:
                found.emplace_back(one.name, value.f64);
        }
    }
    return found;
}

RasterPass::RasterPass(Device& device, VkPipelineCache cache, std::string_view shader, const RasterSetup& setup)
    : PassBase(device, std::string(shader)), setup_(setup) {
    const std::string front = setup.front.empty() ? name_ : setup.front;
    add_stage(VK_SHADER_STAGE_VERTEX_BIT, front + ".vert");
    if (setup.patch_points) {
        add_stage(VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT, front + ".tesc");
        add_stage(VK_SHADER_STAGE_TESSELLATION_EVALUATION_BIT, front + ".tese");
    }
    if (!setup.geometry.empty()) add_stage(VK_SHADER_STAGE_GEOMETRY_BIT, setup.geometry + ".geom");
    add_stage(VK_SHADER_STAGE_FRAGMENT_BIT, name_ + ".frag");
    create_pipeline(cache, create_stages(setup.constants));
}

void RasterPass::create_pipeline(VkPipelineCache cache, std::span<const VkPipelineShaderStageCreateInfo> stages) {
    VkPipelineVertexInputStateCreateInfo input{VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
    VkPipelineInputAssemblyStateCreateInfo assembly{VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO};
    assembly.topology = setup_.patch_points ? VK_PRIMITIVE_TOPOLOGY_PATCH_LIST : VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
    VkPipelineTessellationStateCreateInfo tessellation{VK_STRUCTURE_TYPE_PIPELINE_TESSELLATION_STATE_CREATE_INFO};
    tessellation.patchControlPoints = setup_.patch_points;
    VkPipelineViewportStateCreateInfo viewport{VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO};
    viewport.viewportCount = viewport.scissorCount = 1;
    VkPipelineRasterizationConservativeStateCreateInfoEXT conservative{
        VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_CONSERVATIVE_STATE_CREATE_INFO_EXT};
    conservative.conservativeRasterizationMode = VK_CONSERVATIVE_RASTERIZATION_MODE_OVERESTIMATE_EXT;
    conservative.extraPrimitiveOverestimationSize = device_.features.overestimation;
    VkPipelineRasterizationStateCreateInfo raster{VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO};
    if (setup_.overestimate) raster.pNext = &conservative;
    raster.cullMode = VK_CULL_MODE_NONE;
    raster.lineWidth = 1;
    VkPipelineMultisampleStateCreateInfo multisample{VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO};
    multisample.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
    const bool has_depth = setup_.depth != VK_COMPARE_OP_ALWAYS;
    VkPipelineDepthStencilStateCreateInfo depth{VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO};
    depth.depthTestEnable = depth.depthWriteEnable = has_depth;
    depth.depthCompareOp = setup_.depth;
    VkPipelineColorBlendAttachmentState attachment{};
    attachment.colorWriteMask =
        VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT | VK_COLOR_COMPONENT_B_BIT | VK_COLOR_COMPONENT_A_BIT;
    const std::vector<VkPipelineColorBlendAttachmentState> attachments(setup_.colors.size(), attachment);
    VkPipelineColorBlendStateCreateInfo blend{VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO};
    blend.attachmentCount = uint32_t(attachments.size());
    blend.pAttachments = attachments.data();
    const VkDynamicState states[] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
    VkPipelineDynamicStateCreateInfo dynamic{VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO, nullptr, 0, 2,
                                             states};
    VkPipelineRenderingCreateInfo rendering{VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO};
    rendering.colorAttachmentCount = uint32_t(setup_.colors.size());
    rendering.pColorAttachmentFormats = setup_.colors.data();
    rendering.depthAttachmentFormat = has_depth ? VK_FORMAT_D32_SFLOAT : VK_FORMAT_UNDEFINED;

    VkGraphicsPipelineCreateInfo info{VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO, &rendering};
    info.stageCount = uint32_t(stages.size());
    info.pStages = stages.data();
    info.pVertexInputState = &input;
    info.pInputAssemblyState = &assembly;
    info.pTessellationState = setup_.patch_points ? &tessellation : nullptr;
    info.pViewportState = &viewport;
    info.pRasterizationState = &raster;
    info.pMultisampleState = &multisample;
    info.pDepthStencilState = &depth;
    info.pColorBlendState = &blend;
    info.pDynamicState = &dynamic;
    info.layout = layout_;
    const VkResult result = device_.vk.vkCreateGraphicsPipelines(device_.handle, cache, 1, &info, nullptr, &pipeline_);
    destroy_modules(stages);
    check_vulkan(result, "compiling the shader " + name_);
}

}  // namespace peelray
