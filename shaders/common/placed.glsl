// Triangles as they stand in the world. Include after the buffers positions, triangles and instances.
#ifndef PEELRAY_PLACED_GLSL
#define PEELRAY_PLACED_GLSL

#include "common/instance.h"

/// A corner relative to `from`, with a rounding as if it stood there in the file where its body was not moved. The same in
/// every pass, bit by bit.
vec3 placedFrom(GpuTransform to_world, vec3 p, vec3 from) {
    precise vec3 placed = to_world.linear[0] * p.x + to_world.linear[1] * p.y + to_world.linear[2] * p.z + (to_world.position - from);
    return placed;
}

/// The corners of a triangle of an instance, relative to `from`.
void placedTriangle(uint instance, uint triangle, vec3 from, out vec3 a, out vec3 b, out vec3 c) {
    const GpuTransform to_world = instances[instance].to_world;
    const uvec3 corners = triangles[triangle];
    a = placedFrom(to_world, positions[corners.x], from);
    b = placedFrom(to_world, positions[corners.y], from);
    c = placedFrom(to_world, positions[corners.z], from);
}

#endif
