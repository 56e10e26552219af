// Constants that the builder and the traversal of the cube must agree on.
#ifndef PEELRAY_SAMPLE_GLSL
#define PEELRAY_SAMPLE_GLSL

/// How far a sample may lie off its own voxel and still be looked at, in voxels: rounding of coordinates up to 2048 voxels
/// and the quantised plane (w: 4e-5, slopes: 8e-5), see docs/data.md.
const float PEELRAY_POSITION_SLACK = 2e-3;
const float PEELRAY_PLANE_SLACK = 5e-4;
/// Slopes are stored in [-this, this]: beyond 1 only in the overlap band of `planar` (1 / LDC_OVERLAP).
const float PEELRAY_SLOPE_RANGE = 1.25;
/// Half-width of a sample's footprint for `planar` hits, in pixels.
const float PEELRAY_FOOTPRINT = 0.7;

#endif
