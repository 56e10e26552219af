// There is nothing along the ray.
#version 460
#extension GL_EXT_ray_tracing : require
#include "common/common.glsl"
#include "common/ray.h"
#include "khr/khr_ray.glsl"
layout(location = KHR_NEAREST) rayPayloadInEXT KhrRay traced;

void main() { traced.triangle = NO_TRIANGLE; }
