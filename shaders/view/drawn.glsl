// Drawn triangles by number: over all draws, their instances and their triangles, in that order. Include after the buffers
// frame and draws.
#ifndef PEELRAY_DRAWN_GLSL
#define PEELRAY_DRAWN_GLSL

#include "common/ray.h"
#include "view/view_params.h"

SurfaceId drawnSurface(uint number) {
    uint low = 0u, high = frame[0].draws - 1u;  // the last draw that begins at or before the number
    while (low < high) {
        const uint middle = (low + high + 1u) / 2u;
        if (draws[middle].first_number <= number)
            low = middle;
        else
            high = middle - 1u;
    }
    const GpuDraw draw = draws[low];
    const uint place = number - draw.first_number;
    return SurfaceId(draw.first_instance + place / draw.triangles, draw.first_triangle + place % draw.triangles);
}

#endif
