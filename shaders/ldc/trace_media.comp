// Traces a queue of rays where media may overlap, by voxel.
#version 460
#define PEELRAY_ONLY_VOXELS
#include "ldc/trace_media.glsl"
