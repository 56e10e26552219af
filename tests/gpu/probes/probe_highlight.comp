// What a rough surface sends to the viewer from the direction of one sample.
#version 460
#include "common/common.glsl"
#include "lobe_probe.glsl"
#include "probe.glsl"
struct Output { vec3 half_vector; float highlight, masking; };
PROBE(Input, Output)

Output probe(Input x) {
    Output o;
    const Lobe lobe = lobeOf(x.surface, Material(x.roughness), x.view);
    o.half_vector = sampleMicrofacet(lobe, x.view, x.random);
    const vec3 to_light = reflect(-x.view, o.half_vector);
    o.highlight = highlight(lobe, x.view, to_light, o.half_vector);
    o.masking = masking(lobe, to_light);
    return o;
}
