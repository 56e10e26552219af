// Directions to the sky.
#version 460
#include "common/common.glsl"
#include "path/shading.glsl"
#include "probe.glsl"
struct Input { vec3 normal; vec2 random; };
PROBE(Input, vec3)

vec3 probe(Input x) { return cosineDirection(x.normal, x.random); }
