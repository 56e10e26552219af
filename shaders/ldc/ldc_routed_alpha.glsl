// The alpha test of fragments: the same as the compute rasteriser's. Include after LDC_ROUTED(in) and the buffer bodies.
layout(constant_id = 3) const bool masked = false;  // centres where a material has a hole give no samples
BUFFER(readonly, 0, vec3, positions)
BUFFER(readonly, 1, uvec3, triangles)
#define BASE_COLOR_FIRST_BINDING 10
#include "common/base_color_buffers.glsl"
#include "ldc/ldc_alpha.glsl"

bool routedPresent(ivec2 pixel) { return !masked || ldcPresent(bodies[routed_id.y].grid, routed_id.x, vec2(pixel) + 0.5); }
