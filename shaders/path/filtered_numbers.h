// EnvironmentMode::filtered: what shaders, reference and whoever prepares the environment must agree on
// (src/scene/filtered_environment.h).
#ifndef PEELRAY_FILTERED_NUMBERS_H
#define PEELRAY_FILTERED_NUMBERS_H

// Directions that stand for all of the environment's light, half of which a surface faces.
#define FILTERED_DIRECTIONS 64
// Sets of them, of which samples of a pixel take one after another.
#define FILTERED_SETS 16
// Rows of the levels of wide lobes at least: few would show where texels meet, and the poles.
#define FILTERED_LEAST_ROWS 16

#endif
