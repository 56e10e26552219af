// Fresnel reflectance and refraction.
#version 460
#include "common/common.glsl"
#include "path/shading.glsl"
#include "probe.glsl"
struct Input { vec3 incoming, normal; float eta; };
struct Output { float reflectance, schlick; uint refracts; vec3 refracted; };
PROBE(Input, Output)

Output probe(Input x) {
    Output o;
    const float cosine = -dot(x.incoming, x.normal);
    o.reflectance = fresnelDielectric(cosine, x.eta);
    o.schlick = fresnelSchlick(vec3(0.04), 1.0, cosine).x;
    o.refracts = refractRay(x.incoming, x.normal, x.eta, o.refracted) ? 1u : 0u;
    return o;
}
