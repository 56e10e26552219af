#include "ldc/stream_rasterizer.h"

#include <algorithm>

#include "base/error.h"

namespace peelray {

StreamRasterizer::StreamRasterizer(Device& device, const Cubes& cubes) {
    const CubeLayout& layout = cubes.layout();
    if (layout.builder != BuilderKind::abuffer || layout.routing != Routing::geometry || !layout.by_pixel() ||
        cubes.sampling() == Sampling::conservative)
        fail(
            "drawn streams are captured by {} abuffer with {} geometry, for {} two-level or mipmap and {} planar or "
            "tolerance",
            setting::builder, setting::routing, setting::traversal, setting::hit);
    for (const CubeBody& body : cubes.bodies()) side_ = std::max(side_, round_resolution(body.resolution));
    check_builder(device.features, device.limits(), device.info().name, layout, cubes.sampling(), side_);
}

void StreamRasterizer::guess(BuildState& state, const BuildSize&) {
    state.params.viewport = viewport_side(side_);
}

void StreamRasterizer::allocate(Commands&, BuildState& state) {
    ensure_size(state.device, state.captured, "captured attributes",
                uint64_t(state.params.fragment_capacity) * sizeof(LdcCaptured));
}

void StreamRasterizer::record(Commands& commands, const BuildState& state, const TriangleBuffers&) {
    for (const DrawnStream& stream : state.streams) {
        if (stream.patch_points && !state.device.features.tessellation_shader)
            fail("the device '{}' has no tessellation shaders, which the stream {} needs: use another {}",
                 state.device.info().name, stream.front, setting::device);
        RasterSetup setup;
        setup.front = stream.front;
        setup.geometry = "ldc_stream";
        setup.patch_points = stream.patch_points;
        setup.colors = {};
        setup.depth = VK_COMPARE_OP_ALWAYS;
        setup.constants = stream.constants;
        std::vector<Binding> bindings = {{"counters", state.counters},
                                         {"bodies", state.cubes.table.entries},
                                         {"fragments", state.fragments},
                                         {"captured", state.captured}};
        bindings.insert(bindings.end(), stream.bindings.begin(), stream.bindings.end());
        LdcParams p = state.params;
        p.first_body += stream.body;
        p.bodies = 1;
        DrawTargets targets;
        targets.width = targets.height = side_;
        targets.viewport = p.viewport;
        // One by one: each appends behind what those before it left.
        for (uint64_t draw = 0; draw < stream.draws; draw++)
            commands.draw_indirect(state.device.raster_pass(stream.fragments, setup), bindings, p,
                                   {*stream.arguments, draw * sizeof(DrawArguments), 1}, targets);
    }
}

}  // namespace peelray
