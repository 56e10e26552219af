#include "ldc/abuffer_rasterizer.h"

#include <algorithm>

#include "base/error.h"

namespace peelray {

AbufferRasterizer::AbufferRasterizer(Device& device, const Cubes& cubes)
    : routed_(routed_setup(device, cubes.layout(), cubes.sampling(), false)) {
    routed_.setup.colors = {};
    routed_.setup.depth = VK_COMPARE_OP_ALWAYS;
    for (const CubeBody& body : cubes.bodies()) side_ = std::max(side_, round_resolution(body.resolution));
}

void AbufferRasterizer::guess(BuildState& state, const BuildSize& size) {
    state.params.viewport = viewport_side(side_);
    if (size.triangles * routed_.vertices > ~0u)
        fail("{} triangles are more than {} abuffer can draw with {} draws: use {} geometry, or {} compute",
             size.triangles, setting::builder, setting::routing, setting::routing, setting::builder);
}

void AbufferRasterizer::record(Commands& commands, const BuildState& state, const TriangleBuffers& triangles) {
    record_inspect(commands, state, triangles);
    const LdcParams& p = state.params;
    const DrawRange range{0, p.triangles * (routed_.vertices / 3), 0, routed_.instances};
    const Binding bindings[] = {{"positions", triangles.positions}, {"triangles", triangles.triangles},
                                {"counters", state.counters},       {"bodies", state.cubes.table.entries},
                                {"node_masks", state.node_masks},   {"fragments", state.fragments}};
    DrawTargets targets;
    targets.width = targets.height = side_;
    targets.viewport = p.viewport;
    const char* pass = state.device.features.fragment_subgroups ? "ldc_abuffer" : "ldc_abuffer_plain";
    commands.draw(state.device.raster_pass(pass, with_hit_materials(routed_.setup, state, triangles)),
                  with_hit_materials(bindings, triangles), p, std::span(&range, 1), targets);
}

}  // namespace peelray
