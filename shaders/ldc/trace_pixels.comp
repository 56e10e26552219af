// Traces a queue of rays in the cubes by pixel.
#version 460
#define PEELRAY_ONLY_PIXELS
#include "ldc/trace_one.glsl"
