// Shades hits where the environment lights without noise; other light that is drawn is not.
#version 460
#define SCATTER_FILTERED
#include "path/scatter.glsl"
