// Shades hits where light is drawn: of the environment, of emitters, of one of many lamps, of lamps with a size, or diffuse.
#version 460
#define SCATTER_DRAWN
#include "path/scatter.glsl"
