// The passes that every view of the scene starts with, be it the picture, a probe's face or a light's: which triangle
// each pixel sees, and the camera rays with their hits.
#pragma once

#include "render/gpu_scene.h"
#include "render/path_queues.h"

namespace peelray {

/// What a view is drawn into.
struct ViewTarget {
    Buffer frame;       ///< one Frame: the view's constants
    Buffer visibility;  ///< two uint32 of what each pixel sees, row by row; second ~0: nothing (shaders/view/seen.glsl)
    Image2D color, depth;

    explicit ViewTarget(Device& device) : frame(device, "frame constants", sizeof(Frame)) {}
    /// Makes the images exactly this large.
    void resize(Device& device, uint32_t width, uint32_t height);
};

/// What surfaceAt() of frame.glsl reads, and `others`.
std::vector<Binding> surface_bindings(const GpuScene& scene, const Buffer& frame,
                                      std::initializer_list<Binding> others);

/// Draws the scene's triangles into `target`: NAME.vert with NAME.frag, or NAME_masked.frag where a material is masked.
/// `others`: what NAME.vert reads beside frame, positions, triangles and instances.
template <typename Params>
void record_view(Commands& commands, Device& device, const std::string& name, const GpuScene& scene,
                 const ViewTarget& target, std::initializer_list<Binding> others, const Params& params) {
    std::vector<Binding> bindings = {{"frame", target.frame},
                                     {"positions", scene.triangles.positions},
                                     {"triangles", scene.triangles.triangles},
                                     {"instances", scene.instances.table()}};
    for (const Binding& other : others) bindings.push_back(other);
    const bool masked = scene.triangles.masks != nullptr;
    RasterSetup setup;
    setup.front = name;
    setup.constants = {{"single_sided", scene.triangles.sides != nullptr}};
    const RasterPass& pass = device.raster_pass(masked ? name + "_masked" : name, setup);
    for (const Binding& binding : if_used(base_color_bindings(scene.base_colors))) bindings.push_back(binding);
    commands.draw(pass, bindings, params, scene.draws, target.color, target.depth, target.visibility);
}

/// Camera rays and their hits, from the triangles in `target`: level 0 of the queues. `by_number`: ComputeView found
/// them.
void record_primary(Commands& commands, Device& device, const GpuScene& scene, const ViewTarget& target,
                    PathQueues& queues, const LevelParams& params, bool by_number = false);

}  // namespace peelray
