#include "ldc/graphics_raster.h"

#include <algorithm>
#include <bit>

#include "base/error.h"

namespace peelray {

void check_builder(const DeviceFeatures& features, const VkPhysicalDeviceLimits& limits, const std::string& device,
                   const CubeLayout& layout, Sampling sampling, uint32_t resolution) {
    if (layout.builder == BuilderKind::compute) return;
    const char* name = layout.builder == BuilderKind::peel ? "peel" : "abuffer";
    check_captures(layout.builder, sampling);
    if (!features.fragment_stores)
        fail("the device '{}' cannot write buffers in fragment shaders, which {} {} needs: use {} compute", device,
             setting::builder, name, setting::builder);
    if (layout.routing == Routing::geometry && !features.geometry_shader)
        fail("the device '{}' has no geometry shader: use {} draws, or {} compute", device, setting::routing,
             setting::builder);
    if (layout.builder == BuilderKind::peel && layout.routing == Routing::draws && !features.first_instance)
        fail(
            "the device '{}' lacks drawIndirectFirstInstance, which peeling with {} draws needs: use {} geometry, or "
            "{} abuffer or compute",
            device, setting::routing, setting::routing, setting::builder);
    const uint32_t side = viewport_side(resolution);
    const uint32_t most = std::min({limits.maxFramebufferWidth, limits.maxFramebufferHeight,
                                    limits.maxViewportDimensions[0], limits.maxViewportDimensions[1],
                                    layout.builder == BuilderKind::peel ? limits.maxImageDimension2D : ~0u});
    if (side > most)
        fail(
            "the device '{}' draws into at most {} pixels a side, too few for LDIs of {} pixels: use a smaller {}, or "
            "{} compute",
            device, most, resolution, setting::ldc, setting::builder);
    if (layout.builder == BuilderKind::peel && std::min(limits.maxImageArrayLayers, limits.maxFramebufferLayers) < 3)
        fail("the device '{}' has no targets of three layers: use {} abuffer or compute", device, setting::builder);
}

RoutedSetup routed_setup(const Device& device, const CubeLayout& layout, Sampling sampling, bool layered) {
    const bool geometry = layout.routing == Routing::geometry;
    const bool overestimate = sampling == Sampling::conservative && device.features.overestimation > 0;
    const bool dilated = sampling == Sampling::conservative && !overestimate;
    RoutedSetup result;
    result.setup.front = "ldc_route";
    if (geometry) result.setup.geometry = "ldc_route";
    result.setup.overestimate = overestimate;
    result.setup.constants = {{"by_geometry", geometry}, {"dilated", dilated}};
    if (geometry) result.setup.constants.push_back({"layered", layered});
    result.vertices = dilated && !geometry ? 15 : 3;  // a triangle grown by a square has seven sides
    result.instances = geometry ? 1 : 3;
    return result;
}

RasterSetup with_hit_materials(const RasterSetup& setup, const BuildState& state, const TriangleBuffers& triangles) {
    RasterSetup result = setup;
    result.constants.push_back({"masked", state.tests_alpha(triangles)});
    return result;
}

uint32_t viewport_side(uint32_t resolution) {
    return std::bit_ceil(round_resolution(resolution));
}

void record_inspect(Commands& commands, const BuildState& state, const TriangleBuffers& triangles) {
    commands.run(state.device.pass("ldc_inspect"),
                 {{"positions", triangles.positions},
                  {"triangles", triangles.triangles},
                  {"counters", state.counters},
                  {"bodies", state.cubes.table.entries}},
                 state.params, groups_for(state.params.triangles, 64));
}

}  // namespace peelray
