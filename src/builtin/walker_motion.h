// How the figure stands, walks and waves. Private to src/builtin.
#pragma once

#include "builtin/walker_pose.h"

namespace peelray {

/// The figure walks counter-clockwise (seen from above) on a circle around the origin.
struct WalkPath {
    float radius = 1.2f;  ///< metres
    int strides = 8;      ///< of two steps each, once around
    float stride_seconds = 0.95f;

    float duration() const { return float(strides) * stride_seconds; }
};

/// Where the root stands after `share` of the way around: on the circle, facing along it.
Placement place_on_path(const WalkPath& path, float share);

/// The pose `phase` strides after the left heel came down, in the space of the root.
WalkerPose walking_pose(const WalkPath& path, float phase);
/// At ease, the weight on one leg.
WalkerPose standing_pose();
/// Standing with the right hand raised, `phase` waves on.
WalkerPose waving_pose(float phase);

}  // namespace peelray
