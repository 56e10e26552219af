// What Commands binds to a pass: matched by name, and what each pass does to it.
#include <algorithm>

#include "base/error.h"
#include "gpu/commands.h"

namespace peelray {
namespace {

constexpr uint32_t kSetsPerPool = 256, kBindingsPerSet = 16;

}  // namespace

Binding Binding::if_used(std::string_view name, const Image2D& image) {
    Binding binding(name, image);
    binding.optional = true;
    if (!image) binding.image = nullptr;
    return binding;
}

std::vector<Binding> if_used(std::span<const Binding> bindings) {
    std::vector<Binding> all(bindings.begin(), bindings.end());
    for (Binding& binding : all) {
        binding.optional = true;
        if (binding.buffer && !*binding.buffer) binding.buffer = nullptr;
        if (binding.image && !*binding.image) binding.image = nullptr;
    }
    return all;
}

VkDescriptorSet Commands::allocate_set(VkDescriptorSetLayout layout) {
    for (;; set_pool_++) {
        if (set_pool_ == set_pools_.size()) {
            const VkDescriptorPoolSize sizes[] = {{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, kSetsPerPool * kBindingsPerSet},
                                                  {VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, kSetsPerPool * 2},
                                                  {VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR, kSetsPerPool}};
            VkDescriptorPoolCreateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO, nullptr, 0, kSetsPerPool,
                                            device_.features.ray_tracing ? 3u : 2u,        sizes};
            VkDescriptorPool pool = VK_NULL_HANDLE;
            check_vulkan(device_.vk.vkCreateDescriptorPool(device_.handle, &info, nullptr, &pool),
                         "creating a descriptor pool");
            set_pools_.push_back(pool);
        }
        VkDescriptorSetAllocateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO, nullptr, set_pools_[set_pool_],
                                         1, &layout};
        VkDescriptorSet set = VK_NULL_HANDLE;
        const VkResult result = device_.vk.vkAllocateDescriptorSets(device_.handle, &info, &set);
        if (result == VK_SUCCESS) return set;
        if (result != VK_ERROR_OUT_OF_POOL_MEMORY && result != VK_ERROR_FRAGMENTED_POOL)
            check_vulkan(result, "allocating descriptors");
    }
}

// All is checked before anything is recorded: a refused pass leaves the recording as it was.
std::vector<const Binding*> Commands::match(const PassBase& pass, std::span<const Binding> bindings) {
    const auto& wanted = pass.interface().bindings;
    const size_t count = std::ranges::count_if(
        bindings, [&](const Binding& given) { return !given.optional || pass.interface().declares(given.name); });
    if (count != wanted.size())
        fail("the pass {} has {} bindings but was given {} (a programming error)", pass.name(), wanted.size(), count);
    std::vector<const Binding*> matched;
    for (const ShaderBinding& want : wanted) {
        const auto given = std::ranges::find(bindings, want.name, &Binding::name);
        if (given == bindings.end())
            fail("the pass {} was not given '{}' (a programming error)", pass.name(), want.name);
        const bool is_given = want.structure ? given->structure && *given->structure
                              : want.image   ? given->image && *given->image
                                             : given->buffer && *given->buffer;
        const bool takes_dummy =
            given->optional && !given->image && !given->buffer && !given->structure && !want.structure;
        if (!is_given && !takes_dummy)
            fail("the pass {} was given no {} for '{}' (a programming error)", pass.name(),
                 want.structure ? "acceleration structure"
                 : want.image   ? "image"
                                : "buffer",
                 want.name);
        matched.push_back(&*given);
    }
    return matched;
}

const Image2D& Commands::image_of(const Binding& binding) const {
    return binding.image ? *binding.image : device_.dummy_image();
}

VkDescriptorSet Commands::bind(const PassBase& pass, std::span<const Binding* const> given) {
    const auto& wanted = pass.interface().bindings;
    const VkDescriptorSet set = allocate_set(pass.set_layout());
    std::vector<VkDescriptorBufferInfo> infos(wanted.size());
    std::vector<VkDescriptorImageInfo> image_infos(wanted.size());
    std::vector<VkAccelerationStructureKHR> structures(wanted.size());
    std::vector<VkWriteDescriptorSetAccelerationStructureKHR> structure_infos(wanted.size());
    std::vector<VkWriteDescriptorSet> writes;
    for (size_t i = 0; i < wanted.size(); i++) {
        const Binding& binding = *given[i];
        if (wanted[i].image)
            image_infos[i] = {VK_NULL_HANDLE, image_of(binding).view(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
        else if (binding.structure)
            structures[i] = binding.structure->handle();
        else
            infos[i] = {binding.buffer ? binding.buffer->handle() : device_.dummy(wanted[i].writes), 0, VK_WHOLE_SIZE};
        VkWriteDescriptorSet write{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                   nullptr,
                                   set,
                                   wanted[i].binding,
                                   0,
                                   1,
                                   descriptor_type(wanted[i]),
                                   &image_infos[i],
                                   &infos[i],
                                   nullptr};
        if (binding.structure) {
            structure_infos[i] = {VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET_ACCELERATION_STRUCTURE_KHR, nullptr, 1,
                                  &structures[i]};
            write.pNext = &structure_infos[i];
        }
        writes.push_back(write);
    }
    device_.vk.vkUpdateDescriptorSets(device_.handle, uint32_t(writes.size()), writes.data(), 0, nullptr);
    return set;
}

void Commands::touch(const PassBase& pass, std::span<const Binding* const> given, bool& hazard) {
    for (size_t i = 0; i < given.size(); i++) {
        const ShaderBinding& wanted = pass.interface().bindings[i];
        if (wanted.image)
            touch(image_of(*given[i]), false, false, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, hazard);
        else if (given[i]->structure)
            touch(*given[i]->structure, hazard);
        else if (given[i]->buffer)
            touch(*given[i]->buffer, wanted.reads, wanted.writes, hazard);
    }
}

void Commands::mark(const PassBase& pass, std::span<const Binding* const> given) {
    for (size_t i = 0; i < given.size(); i++) {
        const ShaderBinding& wanted = pass.interface().bindings[i];
        if (given[i]->structure) {
            access(given[i]->structure->storage()).read = true;
            for (const Buffer* shown : given[i]->structure->shown) access(*shown).read = true;
        } else if (wanted.image || given[i]->buffer) {
            Access& done = wanted.image ? access(image_of(*given[i])) : access(*given[i]->buffer);
            done.read |= wanted.reads;
            done.written |= wanted.writes;
        }
    }
}

}  // namespace peelray
