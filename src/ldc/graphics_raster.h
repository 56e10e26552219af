// What the builders of the graphics pipeline share. Private to src/ldc.
#pragma once

#include "gpu/device.h"
#include "gpu/pass.h"
#include "ldc/build_stage.h"

namespace peelray {

/// Throws Error with what would work instead unless a device with these abilities can build such cubes of `resolution`
/// voxels along the longest side.
void check_builder(const DeviceFeatures& features, const VkPhysicalDeviceLimits& limits, const std::string& device,
                   const CubeLayout& layout, Sampling sampling, uint32_t resolution);

/// How triangles get into the LDIs that capture them.
struct RoutedSetup {
    RasterSetup setup;      ///< without targets and depth
    uint32_t vertices = 3;  ///< drawn for a triangle
    uint32_t instances = 1;
};

/// `layered`: each LDI is a layer of the targets.
RoutedSetup routed_setup(const Device& device, const CubeLayout& layout, Sampling sampling, bool layered);

/// The setup of a pass whose fragments are tested for holes (shaders/ldc/ldc_routed_alpha.glsl).
RasterSetup with_hit_materials(const RasterSetup& setup, const BuildState& state, const TriangleBuffers& triangles);

/// The power of two that holds LDIs of so many pixels per side.
uint32_t viewport_side(uint32_t resolution);

/// Counts the triangles that the pipeline drops.
void record_inspect(Commands& commands, const BuildState& state, const TriangleBuffers& triangles);

}  // namespace peelray
