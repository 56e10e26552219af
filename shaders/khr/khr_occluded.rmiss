// There is nothing along the ray.
#version 460
#extension GL_EXT_ray_tracing : require
#include "common/common.glsl"
#include "khr/khr_ray.glsl"
layout(location = KHR_OCCLUDED) rayPayloadInEXT uint occluded;

void main() { occluded = 0u; }
