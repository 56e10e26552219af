// What fragments of views with masked materials share: bindings as in the vertex shaders.
#include "common/instance.h"
#include "common/ray.h"
#include "path/frame.h"
BUFFER(readonly, 0, Frame, frame)
BUFFER(readonly, 1, vec3, positions)
BUFFER(readonly, 2, uvec3, triangles)
BUFFER(readonly, 3, GpuInstance, instances)
#define BASE_COLOR_FIRST_BINDING 4
#include "common/base_color_buffers.glsl"
#include "common/material.glsl"
#include "view/camera.glsl"
#include "view/camera_hit.glsl"

/// Is there a surface where the camera's ray through the fragment's sample meets the triangle? By the ray that primary.comp
/// takes, not by interpolation: rasterisers snap corners.
bool fragmentPresent(uvec2 surface, vec2 jitter) {
    if (!alphaMasked(surface.y)) return true;
    const Hit hit = cameraHit(cameraRay(floor(gl_FragCoord.xy) + jitter), SurfaceId(surface.x, surface.y));
    return alphaPresent(surface.y, vec2(hit.u, hit.v));
}
