// Traces the queue of shadow rays where media may overlap, by pixel.
#version 460
#define PEELRAY_ONLY_PIXELS
#include "path/trace_shadow_media.glsl"
