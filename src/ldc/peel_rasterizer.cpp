#include "ldc/peel_rasterizer.h"

#include <algorithm>
#include <cstring>

#include "base/error.h"

namespace peelray {
namespace {

constexpr uint32_t kFirstGuess = 8, kReserve = 2;
/// Passes are recorded one by one: beyond this a single submission would hold the device for seconds.
constexpr uint32_t kMostPasses = 16384;

uint64_t texels_of(uint32_t side) {
    return 3ull * side * side;
}

/// Values of a reduction, all its steps one behind the other.
uint64_t reduction_size(uint64_t count) {
    uint64_t size = count;
    while (count > 1) size += count = (count + LDC_MAX_BLOCK - 1) / LDC_MAX_BLOCK;
    return size;
}

}  // namespace

PeelRasterizer::PeelRasterizer(Device& device, const Cubes& cubes)
    : counting_(routed_setup(device, cubes.layout(), cubes.sampling(), false)),
      peeling_(routed_setup(device, cubes.layout(), cubes.sampling(), true)),
      apart_(cubes.layout().routing == Routing::draws) {
    counting_.setup.colors = {};
    counting_.setup.depth = VK_COMPARE_OP_ALWAYS;
    const bool half = cubes.layout().by_pixel() && cubes.layout().half_depth;
    peeling_.setup.colors = {half ? VK_FORMAT_R16G16B16A16_SFLOAT : VK_FORMAT_R32G32B32A32_SFLOAT,
                             VK_FORMAT_R32G32_UINT};
    peeling_.setup.depth = VK_COMPARE_OP_LESS;
}

void PeelRasterizer::guess(BuildState& state, const BuildSize&) {
    passes_.assign(state.params.bodies, kFirstGuess);
    for (uint32_t i = 0; i < state.params.bodies; i++)
        side_ = std::max(side_, round_resolution(state.cubes.bodies()[state.params.first_body + i].resolution));
}

void PeelRasterizer::allocate(Commands&, BuildState& state) {
    Device& device = state.device;
    ensure_size(device, layer_counts_, "counts of layers", reduction_size(texels_of(side_)) * 4);
    ensure_size(device, complexities_, "depth complexities", passes_.size() * 4);
    if (!complexities_readback_)
        complexities_readback_ =
            Buffer(device, "depth complexities readback", passes_.size() * 4, Buffer::Where::readback);
    const uint64_t passes = *std::max_element(passes_.begin(), passes_.end());
    ensure_size(device, draws_, "draws of peeling", passes * peeling_.instances * sizeof(DrawArguments));
    ensure_size(device, groups_, "workgroups of peeling", passes * 12);
    if (depth_) return;
    const auto image = [&](const char* name, VkFormat format, VkImageUsageFlags usage, VkImageAspectFlags aspect) {
        return Image2D(device, name, side_, side_, format, usage, aspect, 3);
    };
    const VkImageUsageFlags color = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
    for (int i = 0; i < 2; i++) {
        depth_maps_[i] =
            image("the LDIs' normals and depths", peeling_.setup.colors[0], color, VK_IMAGE_ASPECT_COLOR_BIT);
        id_maps_[i] = image("the LDIs' colours and ids", peeling_.setup.colors[1], color, VK_IMAGE_ASPECT_COLOR_BIT);
    }
    depth_ = image("the LDIs' depth buffer", VK_FORMAT_D32_SFLOAT, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT,
                   VK_IMAGE_ASPECT_DEPTH_BIT);
}

void PeelRasterizer::record(Commands& commands, const BuildState& state, const TriangleBuffers& triangles) {
    record_inspect(commands, state, triangles);
    commands.fill(complexities_, 0);
    for (uint32_t i = 0; i < passes_.size(); i++) record_body(commands, state, triangles, i);
    commands.copy(complexities_, complexities_readback_, passes_.size() * 4);
}

/// Fragments per pixel, then their maximum. Returns its place in the counts.
uint32_t PeelRasterizer::record_complexity(Commands& commands, const BuildState& state,
                                           const TriangleBuffers& triangles, const LdcParams& p) {
    const uint32_t texels = uint32_t(texels_of(p.side));
    commands.fill(layer_counts_, 0, 0, texels * 4ull);
    const Binding bindings[] = {{"positions", triangles.positions},
                                {"triangles", triangles.triangles},
                                {"counters", state.counters},
                                {"bodies", state.cubes.table.entries},
                                {"layer_counts", layer_counts_}};
    const DrawRange range{0, p.triangles, 0, counting_.instances};
    DrawTargets targets;
    targets.width = targets.height = p.side;
    targets.viewport = p.viewport;
    commands.draw(state.device.raster_pass("ldc_peel_count", with_hit_materials(counting_.setup, state, triangles)),
                  with_hit_materials(bindings, triangles), p, std::span(&range, 1), targets);
    MaxParams step{0, texels, texels};
    while (step.count > 1) {
        commands.run(state.device.pass("ldc_max"), {{"layer_counts", layer_counts_}}, step,
                     groups_for(step.count, LDC_MAX_BLOCK));
        step.from = step.to;
        step.count = (step.count + LDC_MAX_BLOCK - 1) / LDC_MAX_BLOCK;
        step.to = step.from + step.count;
    }
    return step.from;
}

void PeelRasterizer::record_body(Commands& commands, const BuildState& state, const TriangleBuffers& triangles,
                                 uint32_t index) {
    LdcParams p = state.params;
    const CubeBody& body = state.cubes.bodies()[p.first_body + index];
    if (body.triangles == 0) return;
    p.first_body += index;
    p.bodies = 1;
    p.first_triangle = body.first_triangle;
    p.triangles = body.triangles;
    p.side = round_resolution(body.resolution);
    p.viewport = viewport_side(p.side);
    Device& device = state.device;
    const uint32_t place = record_complexity(commands, state, triangles, p), passes = passes_[index];
    const uint32_t draws = peeling_.instances, texels = uint32_t(texels_of(p.side));
    commands.run(device.pass("ldc_peel_plan"),
                 {{"counters", state.counters},
                  {"layer_counts", layer_counts_},
                  {"complexities", complexities_},
                  {"draws", draws_},
                  {"groups", groups_}},
                 PeelPlanParams{place, index, passes, 3 * p.triangles, draws, texels}, groups_for(passes, 64));

    const RasterPass& peel = device.raster_pass("ldc_peel", with_hit_materials(peeling_.setup, state, triangles));
    for (p.level = 0; p.level < passes; p.level++) {
        const Image2D &depth_map = depth_maps_[p.level & 1], &id_map = id_maps_[p.level & 1];
        DrawTargets targets{{&depth_map, &id_map}, &depth_, p.side, p.side, p.viewport, 3, apart_};
        const Binding bindings[] = {{"positions", triangles.positions},
                                    {"triangles", triangles.triangles},
                                    {"counters", state.counters},
                                    {"bodies", state.cubes.table.entries},
                                    {"depth_map", depth_maps_[(p.level & 1) ^ 1]},
                                    {"id_map", id_maps_[(p.level & 1) ^ 1]}};
        commands.draw_indirect(peel, with_hit_materials(bindings, triangles), p,
                               {draws_, uint64_t(p.level) * draws * sizeof(DrawArguments), draws}, targets);
        commands.run_indirect(device.pass("ldc_peel_emit"),
                              {{"positions", triangles.positions},
                               {"triangles", triangles.triangles},
                               {"counters", state.counters},
                               {"bodies", state.cubes.table.entries},
                               {"node_masks", state.node_masks},
                               {"fragments", state.fragments},
                               {"depth_map", depth_map},
                               {"id_map", id_map}},
                              p, groups_, uint64_t(p.level) * 12);
    }
}

bool PeelRasterizer::grow(BuildState& state, const BuildCounts& counts) {
    // Nothing was drawn: the order's turn.
    if (counts.cells > state.params.cell_capacity) return false;
    std::vector<uint32_t> layers(passes_.size());
    std::memcpy(layers.data(), complexities_readback_.mapped(), layers.size() * 4);
    bool grown = false;
    for (size_t i = 0; i < layers.size(); i++) {
        if (layers[i] > kMostPasses)
            fail("{} layers lie over one pixel, more than {} peel makes passes ({}): use {} abuffer or compute",
                 layers[i], setting::builder, kMostPasses, setting::builder);
        grown |= layers[i] > passes_[i];
        // Fewer at once, more only with room for them.
        passes_[i] = layers[i] > passes_[i] ? layers[i] + kReserve : std::min(passes_[i], layers[i] + kReserve);
    }
    return grown;
}

uint64_t PeelRasterizer::bytes() const {
    uint64_t bytes = depth_.bytes();
    for (int i = 0; i < 2; i++) bytes += depth_maps_[i].bytes() + id_maps_[i].bytes();
    for (const Buffer* buffer : {&layer_counts_, &complexities_, &draws_, &groups_}) bytes += buffer->bytes();
    return bytes;
}

}  // namespace peelray
