// What the traversal asks about the material of a hit. Include after base_color_buffers.glsl, the specialisation constants `masked` and
// `single_sided` (the scene has such materials), and before peelray/peelray.glsl. HITS_TO_LIGHT: the rays go from surfaces to lights.
// After cube_fetch.glsl. HITS_FORGET: rays do not meet a triangle again that they have passed (media_forget.glsl).
#include "common/material.glsl"
/// The triangle whose material a hit has.
uint hitTriangle(uint triangle) { return cubeSurface(0u, triangle).y; }
#ifdef HITS_FORGET
#include "path/media_forget.glsl"
#define PEELRAY_VISIT(instance) media_visited = instance
bool hitForgotten(uint triangle) {
    const uvec2 surface = cubeSurface(media_visited, triangle);
    return mediaForgotten(surface.x, surface.y);
}
#define PEELRAY_ACCEPT(triangle, uv) (!hitForgotten(triangle) && (!masked || alphaPresent(hitTriangle(triangle), uv)))
#else
#define PEELRAY_ACCEPT(triangle, uv) (!masked || alphaPresent(hitTriangle(triangle), uv))
#endif
#ifdef HITS_TO_LIGHT
// Light comes the other way: it meets the front where the ray meets the back.
#define PEELRAY_SHOWN(triangle, front) (!single_sided || !(front) || !singleSided(hitTriangle(triangle)))
#else
#define PEELRAY_SHOWN(triangle, front) (!single_sided || (front) || !singleSided(hitTriangle(triangle)))
#endif
