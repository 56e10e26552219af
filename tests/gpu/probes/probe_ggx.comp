// GGX: a sampled normal, density and masking at a cosine.
#version 460
#include "common/common.glsl"
#include "path/shading.glsl"
#include "probe.glsl"
struct Input { vec3 view; float alpha; vec2 random; };
struct Output { vec3 half_vector; float density, masking; };
PROBE(Input, Output)

Output probe(Input x) {
    Output o;
    o.half_vector = sampleGgx(x.view, x.alpha, x.random);
    o.density = ggxDistribution(o.half_vector.z, x.alpha);
    o.masking = ggxMasking(x.view.z, x.alpha);
    return o;
}
