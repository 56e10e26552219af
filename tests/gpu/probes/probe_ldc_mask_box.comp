// ldcMaskBox.
#version 460
#include "ldc_common.glsl"
#include "probe.glsl"
struct Input { ivec3 lo, hi; };
PROBE(Input, uvec2)

uvec2 probe(Input x) { return ldcMaskBox(x.lo, x.hi); }
