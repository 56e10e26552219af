// The camera at the moment before a picture's.
#ifndef PEELRAY_CAMERA_BEFORE_H
#define PEELRAY_CAMERA_BEFORE_H

#include "common/shared.h"

#ifdef __cplusplus
namespace peelray {
#endif

/// As in Frame, and what has moved since.
struct CameraBefore {
    vec3 eye;
    float near;
    vec3 right;
    uint orthographic;
    vec3 up;
    uint first_moving;  ///< from this vertex on positions change from moment to moment
    vec3 forward;
};
SHARED_SIZE(CameraBefore, 60);

#ifdef __cplusplus
}  // namespace peelray
#endif
#endif
