// Rays and hits in queues.
#ifndef PEELRAY_RAY_H
#define PEELRAY_RAY_H

#include "common/shared.h"

#ifdef __cplusplus
namespace peelray {
#endif

/// A ray in a queue.
struct Ray {
    vec3 origin;
    float tmin;
    vec3 direction;
    float tmax;
};
SHARED_SIZE(Ray, 32);

/// A hit in a queue.
struct Hit {
    float t;        ///< +inf: a miss
    uint triangle;  ///< of the triangle buffer; NO_TRIANGLE: a miss
    uint instance;
    float u;
    float v;
};
SHARED_SIZE(Hit, 20);
#define NO_TRIANGLE 0xffffffffu

/// A surface that a ray starts on and must not hit.
struct SurfaceId {
    uint instance;
    uint triangle;
};
SHARED_SIZE(SurfaceId, 8);

#ifdef __cplusplus
}  // namespace peelray
#endif
#endif
