// What the paper's pixel shader writes before rays are traced (section 2.1, Figure 7): of every pixel's mirror ray its direction,
// where it leaves the box, and how it looks in the three LDIs. A picture of the method: the traversal computes the same in
// registers, which costs less than reading it back.
#version 460
#include "common/common.glsl"
#include "path/aov_records.h"
#include "path/frame.h"
#include "path/path_params.h"
PARAMS(RaySetupParams)
BUFFER(readonly, 0, Frame, frame)
BUFFER(readonly, 1, AovSurface, aovs)
layout(location = 0) out vec4 reflection;
layout(location = 1) out vec4 box_point;
layout(location = 2) out vec4 directions_xy;  // in the x-LDI (y, z), in the y-LDI (z, x)
layout(location = 3) out vec4 directions_z;   // in the z-LDI (x, y)

void main() {
    const uint at = uint(gl_FragCoord.y) * frame[0].width + uint(gl_FragCoord.x);
    reflection = box_point = directions_xy = directions_z = vec4(0);
    if (aovs[at].position.w == 0.0) return;
    const vec3 position = aovs[at].position.xyz;
    const vec3 incoming = frame[0].orthographic != 0u ? frame[0].forward : normalize(position - frame[0].eye);
    const vec3 d = reflect(incoming, aovs[at].normal.xyz);
    const vec3 way = mix(params.lower, params.upper, greaterThan(d, vec3(0))) - position;
    const vec3 t = vec3(d.x == 0.0 ? 1e30 : way.x / d.x, d.y == 0.0 ? 1e30 : way.y / d.y, d.z == 0.0 ? 1e30 : way.z / d.z);
    reflection = vec4(d, 1);
    box_point = vec4(position + max(min(t.x, min(t.y, t.z)), 0.0) * d, 1);
    directions_xy = vec4(d.yz, d.zx);
    directions_z = vec4(d.xy, 0, 0);
}
