// The wave has a round hole, which the alpha test cuts.
#version 460
#include "ldc/ldc_stream.glsl"

void main() {
    if (routed_data0.z == 0.0 && distance(routed_data0.xy, vec2(0.3, -0.2)) < 0.4) discard;
    ldcCapture(normalize(routed_data1.xyz), vec4(0.5 + 0.5 * routed_data0.xy, routed_data0.z, 1));
}
