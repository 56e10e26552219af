// The device's own ray tracing (src/khr).
#ifndef PEELRAY_KHR_PARAMS_H
#define PEELRAY_KHR_PARAMS_H

#include "common/shared.h"

#ifdef __cplusplus
namespace peelray {
#endif

/// A body's acceleration structure.
struct KhrBody {
    uvec2 structure;  ///< its address
    uint first_part;  ///< of its parts in the table of their first triangles
};
SHARED_SIZE(KhrBody, 12);

/// VkAccelerationStructureInstanceKHR.
struct KhrInstance {
    vec4 row_x;  ///< of the way from the body's space into the world
    vec4 row_y;
    vec4 row_z;
    uint part_and_mask;     ///< 24 bits: KhrBody::first_part; 8: the rays that see it
    uint offset_and_flags;  ///< 24 bits: of its hit shaders; 8: VkGeometryInstanceFlagsKHR
    uvec2 structure;        ///< its address; 0: nothing is there
};
SHARED_SIZE(KhrInstance, 64);

struct KhrTraceParams {
    uint count;    ///< rays in the queue; with `counted`: room in the queue
    uint counted;  ///< 1: the count is queue[counter]
    uint counter;
    uint skips;  ///< 1: ray i must not hit skip[i]
};
SHARED_SIZE(KhrTraceParams, 16);

#ifdef __cplusplus
}  // namespace peelray
#endif
#endif
