// Traces the queue of shadow rays by pixel.
#version 460
#define PEELRAY_ONLY_PIXELS
#include "path/trace_shadow_rays.glsl"
