// Primary visibility: every triangle of every instance, drawn with both numbers. Positions relative to the eye, reversed depth.
#version 460
#include "common/common.glsl"
#include "common/instance.h"
#include "path/frame.h"
#include "view/view_params.h"
PARAMS(VisibilityParams)
BUFFER(readonly, 0, Frame, frame)
BUFFER(readonly, 1, vec3, positions)
BUFFER(readonly, 2, uvec3, triangles)
BUFFER(readonly, 3, GpuInstance, instances)
#define BASE_COLOR_FIRST_BINDING 4
#include "common/base_color_buffers.glsl"
layout(constant_id = 0) const bool single_sided = false;  // the scene has single-sided materials
layout(location = 0) flat out uvec2 surface;  // a SurfaceId
#include "common/placed.glsl"
#include "common/project.glsl"
#include "common/sidedness.glsl"
#include "view/view_side.glsl"

/// Is the triangle left out, since the camera is behind it?
bool culled() {
    if (!singleSided(surface.y)) return false;
    vec3 a, b, c;
    placedTriangle(surface.x, surface.y, frame[0].eye, a, b, c);
    return viewSeesBack(a, b, c, surface.x);
}

void main() {
    surface = uvec2(gl_InstanceIndex, uint(gl_VertexIndex) / 3u);
    const vec3 p = positions[triangles[surface.y][uint(gl_VertexIndex) % 3u]];
    // The rasteriser samples pixel centres: moving the picture moves the sample.
    gl_Position = project(placedFrom(instances[surface.x].to_world, p, frame[0].eye),
                          (0.5 - params.jitter) * 2.0 / vec2(frame[0].width, frame[0].height));
    if (single_sided && culled()) gl_Position = vec4(0, 0, 0, 1);  // three equal corners have no area
}
