// The nearest hit.
#version 460
#extension GL_EXT_ray_tracing : require
#include "common/common.glsl"
#include "khr/khr_ray.glsl"
#include "khr/khr_part.glsl"
layout(location = KHR_NEAREST) rayPayloadInEXT KhrRay traced;
hitAttributeEXT vec2 weights;

void main() { traced = KhrRay(khrTriangle(), gl_InstanceID, gl_HitTEXT, weights); }
