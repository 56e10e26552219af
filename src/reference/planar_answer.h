// How far off an answer is that knows surfaces only to within a voxel.
#pragma once

#include "reference/oracle.h"

namespace peelray {

/// How far the hit at `t` (+inf: a miss) is from the right one, across the surface that is right, in world units;
/// infinite: hit against miss.
double distance_off(const Geometry& geometry, const OracleRay& ray, double t, const OracleHit& right);

/// Is the hit at `t` right within a voxel for a parallel ray at most a voxel away from the ray? Samples know edges no
/// better than that.
bool right_beside(const Oracle& oracle, const Geometry& geometry, const OracleRay& ray, double t, double voxel);
/// The same for an any-hit answer.
bool occluded_beside(const Oracle& oracle, const OracleRay& ray, bool occluded, double voxel);

}  // namespace peelray
