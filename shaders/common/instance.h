// Instances of bodies: where they stand in the world.
#ifndef PEELRAY_INSTANCE_H
#define PEELRAY_INSTANCE_H

#include "common/shared.h"

#ifdef __cplusplus
namespace peelray {
#endif

/// Where something stands: p in its own space is linear * p + position in the world.
struct GpuTransform {
    mat3 linear;
    vec3 position;
};
SHARED_SIZE(GpuTransform, 48);

/// The part of an instance that never changes.
struct InstanceInfo {
    uint body;
    uint first_id;      ///< added to the ids of its triangles
    uint first_object;  ///< added to the objects of its triangles
};
SHARED_SIZE(InstanceInfo, 12);

/// A body placed in the world.
struct GpuInstance {
    GpuTransform to_world;
    InstanceInfo info;
    uint moved;     ///< 0: to_world is the identity
    uint mirrored;  ///< 1: the transform turns triangles inside out
    float voxel;    ///< edge of a voxel in the world (the largest, where the transform is not even)
};
SHARED_SIZE(GpuInstance, 72);

#ifdef __cplusplus
}  // namespace peelray
#endif
#endif
