// What the camera sees: view_*.comp and visibility* (src/render).
#ifndef PEELRAY_VIEW_PARAMS_H
#define PEELRAY_VIEW_PARAMS_H

#include "common/shared.h"

#ifdef __cplusplus
namespace peelray {
#endif

/// Triangles of a body in all its instances, one after the other.
struct GpuDraw {
    uint first_number;  ///< of its drawn triangles, counted over all draws
    uint first_triangle;
    uint triangles;  ///< of an instance
    uint first_instance;
};
SHARED_SIZE(GpuDraw, 16);

/// Parameters of the view_* passes.
struct ViewParams {
    vec2 jitter;          ///< sample position in the pixel, [0, 1)
    uint triangles;       ///< drawn, over all instances
    uint block_capacity;  ///< entries of the queue of blocks of large triangles
};
SHARED_SIZE(ViewParams, 16);

struct VisibilityParams {
    vec2 jitter;  ///< sample position in the pixel, [0, 1)
};
SHARED_SIZE(VisibilityParams, 8);

#ifdef __cplusplus
}  // namespace peelray
#endif
#endif
