// Traces the queue of shadow rays by voxel.
#version 460
#define PEELRAY_ONLY_VOXELS
#include "path/trace_shadow_rays.glsl"
