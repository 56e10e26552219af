// Traces the queue of shadow rays through glass by pixel.
#version 460
#define PEELRAY_ONLY_PIXELS
#include "path/trace_shadow_glass.glsl"
