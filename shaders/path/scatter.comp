// Shades hits where no light is drawn.
#version 460
#include "path/scatter.glsl"
