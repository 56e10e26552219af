// The passes that every view of the scene starts with, be it the picture, a probe's face or a light's: which triangle
// each pixel sees, and the camera rays with their hits.
#pragma once

#include "render/gpu_scene.h"
#include "render/path_queues.h"

namespace peelray {

/// What a view is drawn into.
struct ViewTarget {
    Buffer frame;       ///< one Frame: the view's constants
    Buffer visibility;  ///< SurfaceId of what each pixel sees, row by row; triangle ~0: nothing
    Image2D color, depth;

    explicit ViewTarget(Device& device) : frame(device, "frame constants", sizeof(Frame)) {}
    /// Makes the images exactly this large.
    void resize(Device& device, uint32_t width, uint32_t height);
};

/// What surfaceAt() of frame.glsl reads, and `others`.
std::vector<Binding> surface_bindings(const GpuScene& scene, const Buffer& frame,
                                      std::initializer_list<Binding> others);

/// Camera rays and their hits, from the triangles in `target`: level 0 of the queues.
void record_primary(Commands& commands, Device& device, const GpuScene& scene, const ViewTarget& target,
                    PathQueues& queues, const LevelParams& params);

}  // namespace peelray
