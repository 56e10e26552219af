// Traces a queue of rays in the cubes by voxel.
#version 460
#define PEELRAY_ONLY_VOXELS
#include "ldc/trace_one.glsl"
