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
layout(location = 0) flat out uvec2 surface;  // a SurfaceId
#include "common/placed.glsl"
#include "common/project.glsl"

void main() {
    surface = uvec2(gl_InstanceIndex, uint(gl_VertexIndex) / 3u);
    const vec3 p = positions[triangles[surface.y][uint(gl_VertexIndex) % 3u]];
    // The rasteriser samples pixel centres: moving the picture moves the sample.
    gl_Position = project(placedFrom(instances[surface.x].to_world, p, frame[0].eye),
                          (0.5 - params.jitter) * 2.0 / vec2(frame[0].width, frame[0].height));
}
