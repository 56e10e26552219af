// What one sample of a rough surface makes of a ray: half vector, reflected ray, the ray refracted into glass and out of it.
#version 460
#include "common/common.glsl"
#include "lobe_probe.glsl"
#include "probe.glsl"
struct Output { vec3 half_vector, reflected, entering, leaving; uint enters, leaves; };
PROBE(Input, Output)

Output probe(Input x) {
    Output o;
    o.half_vector = sampleMicrofacet(lobeOf(x.surface, Material(x.roughness), x.view), x.view, x.random);
    o.reflected = reflect(-x.view, o.half_vector);
    o.enters = refractRay(-x.view, o.half_vector, x.index, o.entering) ? 1u : 0u;
    o.leaves = refractRay(-x.view, o.half_vector, 1.0 / x.index, o.leaving) ? 1u : 0u;
    return o;
}
