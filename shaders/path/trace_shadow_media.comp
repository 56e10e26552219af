// Traces the queue of shadow rays where media may overlap, by voxel.
#version 460
#define PEELRAY_ONLY_VOXELS
#include "path/trace_shadow_media.glsl"
