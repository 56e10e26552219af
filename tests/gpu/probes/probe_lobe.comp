// What one sample of a rough surface makes of a ray: half vector, reflected ray, the ray refracted into glass and out of it.
#version 460
#include "common/common.glsl"
#include "path/shading.glsl"
#include "probe.glsl"
// What lobe.glsl wants of a surface and its material.
struct Surface { vec3 normal, along; float stretch; };
struct Material { float roughness; };
const bool stretched = true;
vec3 directionOr(vec3 v, vec3 otherwise) { return dot(v, v) > 0.0 ? normalize(v) : otherwise; }
#include "path/lobe.glsl"
struct Input { Surface surface; float roughness; vec3 view; float index; vec2 random; };
struct Output { vec3 half_vector, reflected, entering, leaving; uint enters, leaves; };
PROBE(Input, Output)

Output probe(Input x) {
    Output o;
    o.half_vector = sampleMicrofacet(lobeOf(x.surface, Material(x.roughness)), x.view, x.random);
    o.reflected = reflect(-x.view, o.half_vector);
    o.enters = refractRay(-x.view, o.half_vector, x.index, o.entering) ? 1u : 0u;
    o.leaves = refractRay(-x.view, o.half_vector, 1.0 / x.index, o.leaving) ? 1u : 0u;
    return o;
}
