// randomPair and its hash.
#version 460
#include "common/common.glsl"
#include "path/shading.glsl"
#include "probe.glsl"
struct Input { uvec2 pixel; uint index, dimension; };
struct Output { uvec3 hash; vec2 pair; };
PROBE(Input, Output)

Output probe(Input x) { return Output(hash3(uvec3(x.pixel, x.dimension)), randomPair(hash3(uvec3(x.pixel, 0u)).x, x.index, x.dimension)); }
