// The grid that photons are found in: cubes as wide as a photon is gathered across, whose numbers are hashed into buckets.
#ifndef PEELRAY_PHOTON_GRID_GLSL
#define PEELRAY_PHOTON_GRID_GLSL

#include "path/shading.glsl"

ivec3 photonCell(vec3 position, vec3 lower, float inverse_cell) { return ivec3(floor((position - lower) * inverse_cell)); }

uint photonBucket(ivec3 cell, uint mask) { return hash3(uvec3(cell)).x & mask; }

#endif
