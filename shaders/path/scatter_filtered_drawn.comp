// Shades hits where the environment lights without noise, and other light is drawn.
#version 460
#define SCATTER_DRAWN
#define SCATTER_FILTERED
#include "path/scatter.glsl"
