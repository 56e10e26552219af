// A pass: one shader, the bindings that reflection finds in it, one pipeline.
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "gpu/constants.h"
#include "gpu/device.h"
#include "gpu/shader_table.h"

namespace peelray {

/// A storage buffer, image or acceleration structure of a shader as reflection sees it.
struct ShaderBinding {
    std::string name;  ///< the block's name less "_block" (see shaders/common/common.glsl), or the variable's
    uint32_t binding;
    bool reads, writes;
    bool image = false;      ///< read texel by texel, without a sampler
    bool structure = false;  ///< an acceleration structure
};

/// A specialisation constant as reflection sees it.
struct ShaderConstant {
    std::string name;
    uint32_t id;
};

/// What a shader (or the stages of a pass together) declares.
struct ShaderInterface {
    std::vector<ShaderBinding> bindings;
    std::vector<ShaderConstant> constants;  ///< those that the compiled code uses
    uint32_t push_constant_bytes = 0;
    uint32_t group_size[3] = {1, 1, 1};

    void reflect(std::span<const uint32_t> code);
    bool declares(std::string_view name) const;

  private:
    void add(const ShaderBinding& found);
    void add(const ShaderConstant& found);
};

inline VkDescriptorType descriptor_type(const ShaderBinding& binding) {
    return binding.structure ? VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR
           : binding.image   ? VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE
                             : VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
}

/// Values by constant_id. Each constant of the interface must be given once, by its name, and no other; else throws
/// Error naming `pass`.
std::map<uint32_t, uint32_t> numbered(std::string_view pass, const ShaderInterface& interface,
                                      const Constants& constants);

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
    /// Takes the built-in shader of this name as a stage: adds what it declares to the interface. Returns its number.
    uint32_t add_stage(VkShaderStageFlagBits bit, std::string_view shader);
    /// Makes the layout and the stages that were added, with their constants. The modules are to be destroyed.
    std::vector<VkPipelineShaderStageCreateInfo> create_stages(const Constants& constants);
    void destroy_modules(std::span<const VkPipelineShaderStageCreateInfo> stages);

    Device& device_;
    std::string name_;
    ShaderInterface interface_;
    VkShaderStageFlags stages_ = 0;
    VkDescriptorSetLayout set_layout_ = VK_NULL_HANDLE;
    VkPipelineLayout layout_ = VK_NULL_HANDLE;
    VkPipeline pipeline_ = VK_NULL_HANDLE;

  private:
    struct Stage {
        VkShaderStageFlagBits bit;
        std::span<const uint32_t> code;
    };
    void create_layout();

    std::vector<Stage> added_;
};

/// A compute pass (see Commands::run).
class Pass : public PassBase {
  public:
    Pass(Device& device, VkPipelineCache cache, std::string_view shader, const Constants& constants);

    /// What the driver reports about the compiled shader (registers, spills, ...), under its own names; empty where it
    /// reports nothing (DeviceFeatures::executable_properties).
    std::vector<std::pair<std::string, double>> statistics() const;
};

/// How a rasterising pass is put together.
struct RasterSetup {
    std::string front;          ///< name of the stages before the fragments' (.vert and so on); empty: the pass's own
    std::string geometry = {};  ///< name of the geometry shader (.geom); empty: none
    uint32_t patch_points = 0;  ///< corners of a patch, for FRONT.tesc and FRONT.tese; 0: triangles, no tessellation
    std::vector<VkFormat> colors = {VK_FORMAT_R32G32_UINT};  ///< of the targets; may be empty
    VkCompareOp depth = VK_COMPARE_OP_GREATER;               ///< of a D32 buffer; VK_COMPARE_OP_ALWAYS: there is none
    bool overestimate = false;  ///< every pixel that a triangle touches (DeviceFeatures::overestimation)
    Constants constants = {};   ///< of all stages

    auto operator<=>(const RasterSetup&) const = default;
};

/// A rasterising pass without vertex buffers (see Commands::draw): the vertex shader fetches what it needs.
class RasterPass : public PassBase {
  public:
    RasterPass(Device& device, VkPipelineCache cache, std::string_view shader, const RasterSetup& setup);
    const RasterSetup& setup() const { return setup_; }

  private:
    void create_pipeline(VkPipelineCache cache, std::span<const VkPipelineShaderStageCreateInfo> stages);

    RasterSetup setup_;
};

/// Adds shaders that are not the library's own (tests' probes); call before the first pass() that names one.
void register_shaders(std::span<const EmbeddedShader> shaders);

}  // namespace peelray
