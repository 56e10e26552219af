// A pass: one shader, the bindings that reflection finds in it, one pipeline.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "gpu/device.h"
#include "gpu/shader_table.h"

namespace peelray {

/// A storage buffer of a shader as reflection sees it.
struct ShaderBinding {
    std::string name;  ///< the block's name less its suffix "_block" (see shaders/common.glsl)
    uint32_t binding;
    bool reads, writes;
};

/// What a shader (or a vertex and fragment shader together) declares.
struct ShaderInterface {
    std::vector<ShaderBinding> bindings;
    uint32_t push_constant_bytes = 0;
    uint32_t group_size[3] = {1, 1, 1};

    void reflect(std::span<const uint32_t> code);
    bool declares(std::string_view name) const;
};

/// The part that every kind of pass shares: layout and pipeline.
class PassBase {
  public:
    PassBase(Device& device, std::string name) : device_(device), name_(std::move(name)) {}
    ~PassBase();
    PassBase(const PassBase&) = delete;
    PassBase& operator=(const PassBase&) = delete;

    const std::string& name() const { return name_; }
    const ShaderInterface& interface() const { return interface_; }
    VkPipeline pipeline() const { return pipeline_; }
    VkPipelineLayout layout() const { return layout_; }
    VkDescriptorSetLayout set_layout() const { return set_layout_; }
    VkShaderStageFlags stages() const { return stages_; }

  protected:
    void create_layout();
    VkShaderModule create_module(std::span<const uint32_t> code);

    Device& device_;
    std::string name_;
    ShaderInterface interface_;
    VkShaderStageFlags stages_ = 0;
    VkDescriptorSetLayout set_layout_ = VK_NULL_HANDLE;
    VkPipelineLayout layout_ = VK_NULL_HANDLE;
    VkPipeline pipeline_ = VK_NULL_HANDLE;
};

/// A compute pass (see Commands::run).
class Pass : public PassBase {
  public:
    Pass(Device& device, VkPipelineCache cache, std::string_view shader, const std::vector<uint32_t>& constants);
};

/// A rasterising pass without vertex buffers (see Commands::draw): the vertex shader fetches what it needs.
class RasterPass : public PassBase {
  public:
    RasterPass(Device& device, VkPipelineCache cache, std::string_view shader, std::string_view fragment);
};

/// Adds shaders that are not the library's own (tests' probes); call before the first pass() that names one.
void register_shaders(std::span<const EmbeddedShader> shaders);

}  // namespace peelray
