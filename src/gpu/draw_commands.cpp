// What Commands records of the graphics pipeline.
#include <algorithm>
#include <cassert>

#include "gpu/commands.h"

namespace peelray {
namespace {

constexpr VkPipelineStageFlags2 kGraphics = VK_PIPELINE_STAGE_2_ALL_GRAPHICS_BIT;

}  // namespace

void Commands::record_draw(const RasterPass& pass, std::span<const Binding> bindings, const void* params, size_t bytes,
                           std::span<const DrawRange> ranges, const IndirectDraws* indirect, const DrawTargets& targets,
                           const Buffer* copied) {
    check_params(pass, bytes);
    assert(targets.colors.size() == pass.setup().colors.size());
    const std::vector<const Binding*> given = match(pass, bindings);
    begin();
    bool hazard = false;
    const VkDescriptorSet set = bind(pass, given);
    touch(pass, given, hazard);
    for (const Image2D* color : targets.colors)
        touch(*color, true, true, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, hazard);
    if (targets.depth) touch(*targets.depth, true, true, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL, hazard);
    if (indirect) touch(indirect->arguments, true, false, hazard);
    if (copied) touch(*copied, false, true, hazard);
    barrier_if(hazard, kGraphics);
    mark(pass, given);
    for (const Image2D* color : targets.colors) access(*color).written = true;
    if (targets.depth) access(*targets.depth).written = true;
    if (indirect) access(indirect->arguments).read = true;
    if (copied) access(*copied).written = true;

    start(pass, VK_PIPELINE_BIND_POINT_GRAPHICS, set, params, bytes);
    const uint32_t draws = indirect ? indirect->draws : uint32_t(ranges.size());
    assert(!targets.apart || draws == targets.layers);
    // Nothing to draw still clears the targets.
    for (uint32_t i = 0; i < std::max(draws, 1u); i++) {
        if (i == 0 || targets.apart) begin_rendering(pass, targets, i);
        if (indirect)
            device_.vk.vkCmdDrawIndirect(commands_, indirect->arguments.handle(),
                                         indirect->offset + i * sizeof(VkDrawIndirectCommand), 1, 0);
        else if (i < draws)
            device_.vk.vkCmdDraw(commands_, 3 * ranges[i].triangles, ranges[i].instances, 3 * ranges[i].first_triangle,
                                 ranges[i].first_instance);
        if (i + 1 >= draws || targets.apart) device_.vk.vkCmdEndRendering(commands_);
    }
    if (copied) {
        const Image2D& color = *targets.colors[0];
        bool wait = false;
        touch(color, false, false, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, wait);
        barrier_if(wait, kTransfer);
        VkBufferImageCopy region{};
        region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
        region.imageExtent = {color.width(), color.height(), 1};
        device_.vk.vkCmdCopyImageToBuffer(commands_, color.handle(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                                          copied->handle(), 1, &region);
        access(color).read = true;
        access(*copied).written = true;
    }
    finish();
}

void Commands::begin_rendering(const RasterPass& pass, const DrawTargets& targets, uint32_t layer) {
    const auto attachment = [&](const Image2D& image, VkImageLayout layout) {
        VkRenderingAttachmentInfo info{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
        info.imageView = targets.apart ? image.layer_view(layer) : image.view();
        info.imageLayout = layout;
        info.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
        info.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
        return info;
    };
    std::vector<VkRenderingAttachmentInfo> colors;
    for (const Image2D* image : targets.colors) {
        colors.push_back(attachment(*image, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL));
        if (image->format() == VK_FORMAT_R32G32_UINT)
            colors.back().clearValue.color.uint32[0] = colors.back().clearValue.color.uint32[1] = ~0u;
    }
    VkRenderingInfo rendering{VK_STRUCTURE_TYPE_RENDERING_INFO};
    rendering.renderArea.extent = {targets.width, targets.height};
    rendering.layerCount = targets.apart ? 1 : targets.layers;
    rendering.colorAttachmentCount = uint32_t(colors.size());
    rendering.pColorAttachments = colors.data();
    VkRenderingAttachmentInfo depth{};
    if (targets.depth) {
        depth = attachment(*targets.depth, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL);
        depth.storeOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
        depth.clearValue.depthStencil.depth = pass.setup().depth == VK_COMPARE_OP_GREATER ? 0.0f : 1.0f;
        rendering.pDepthAttachment = &depth;
    }
    const uint32_t side = targets.viewport;
    const VkViewport viewport{0, 0, float(side ? side : targets.width), float(side ? side : targets.height), 0, 1};
    const VkRect2D scissor{{0, 0}, {targets.width, targets.height}};
    device_.vk.vkCmdBeginRendering(commands_, &rendering);
    device_.vk.vkCmdSetViewport(commands_, 0, 1, &viewport);
    device_.vk.vkCmdSetScissor(commands_, 0, 1, &scissor);
}

}  // namespace peelray
