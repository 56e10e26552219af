// What a pixel of a view sees. Include after the buffers frame, draws and visibility.
#ifndef PEELRAY_SEEN_GLSL
#define PEELRAY_SEEN_GLSL

#include "common/ray.h"

#include "view/drawn.glsl"

/// Triangle NO_TRIANGLE: nothing. `by_number`: the view was made by compute (view_triangles.comp), else by the rasteriser.
SurfaceId seenAt(uvec2 pixel, bool by_number) {
    const uvec2 seen = visibility[pixel.y * frame[0].width + pixel.x];
    if (seen.y == NO_TRIANGLE || !by_number) return SurfaceId(seen.x, seen.y);
    return drawnSurface(seen.x);
}

#endif
