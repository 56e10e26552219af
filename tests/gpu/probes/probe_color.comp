// Colour: both sRGB curves and the tone curves.
#version 460
#include "common/common.glsl"
#include "path/shading.glsl"
#include "probe.glsl"
struct Output { vec3 linear, srgb, aces, neutral; };
PROBE(vec3, Output)

Output probe(vec3 x) { return Output(srgbToLinear(x), linearToSrgb(x), tonemapAces(x), tonemapNeutral(x)); }
