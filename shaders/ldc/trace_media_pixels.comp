// Traces a queue of rays where media may overlap, by pixel.
#version 460
#define PEELRAY_ONLY_PIXELS
#include "ldc/trace_media.glsl"
