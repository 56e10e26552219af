// What a probe or a light sees: as visibility.vert, with some triangles left out.
#version 460
#include "common/common.glsl"
#include "common/instance.h"
#include "cubemap/cubemap_params.h"
#include "path/frame.h"
PARAMS(MapVisibilityParams)
BUFFER(readonly, 0, Frame, frame)
BUFFER(readonly, 1, vec3, positions)
BUFFER(readonly, 2, uvec3, triangles)
BUFFER(readonly, 3, GpuInstance, instances)
#define BASE_COLOR_FIRST_BINDING 4
#include "common/base_color_buffers.glsl"
#include "common/material.glsl"
BUFFER(readonly, 10, uint, triangle_objects)
BUFFER(readonly, 11, GpuObject, objects)
layout(location = 0) flat out uvec2 surface;  // a SurfaceId
#include "common/placed.glsl"
#include "common/project.glsl"
#include "common/sidedness.glsl"
#include "view/view_side.glsl"
layout(constant_id = 0) const bool single_sided = false;  // the scene has single-sided materials

bool drawn(vec3 a, vec3 b, vec3 c) {
    const bool transmits = mayTransmit(surface.y);
    const bool back = viewSeesBack(a, b, c, surface.x);
    if (single_sided && back && singleSided(surface.y)) return false;
    if (params.shadow != 0u) return !transmits;
    const uint index = instances[surface.x].info.first_object + triangle_objects[surface.y];
    const GpuObject object = objects[index];
    // A probe inside another closed object must not see its inside: of an object whose box contains the probe, only
    // front faces count. Of all others both sides do, since an open sheet has no back; so they do where the back can be
    // looked through.
    const bool inside = all(greaterThanEqual(frame[0].eye, object.lower)) && all(lessThanEqual(frame[0].eye, object.upper));
    return index != params.left_out && (transmits || !inside || !back);
}

void main() {
    surface = uvec2(gl_InstanceIndex, uint(gl_VertexIndex) / 3u);
    vec3 p[3];
    placedTriangle(surface.x, surface.y, frame[0].eye, p[0], p[1], p[2]);
    const vec2 shift = (0.5 - params.jitter) * 2.0 / vec2(frame[0].width, frame[0].height);
    // Three equal corners have no area.
    gl_Position = drawn(p[0], p[1], p[2]) ? project(p[uint(gl_VertexIndex) % 3u], shift) : vec4(0, 0, 0, 1);
}
