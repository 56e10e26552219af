// A pixel's auxiliary values, in the order of the table.
#ifndef PEELRAY_AOV_RECORDS_H
#define PEELRAY_AOV_RECORDS_H

#include "common/shared.h"
#include "path/aov_table.h"

#ifdef __cplusplus
#include <limits>
#define AOV_INFINITY std::numeric_limits<float>::infinity()
namespace peelray {
#else
#define AOV_INFINITY uintBitsToFloat(0x7f800000u)
#endif

#define AOV_MEMBER(name, type, channels, nothing) type name;

struct AovSurface {
    SEEN_AOVS(AOV_MEMBER)
};

struct AovMotion {
    MOTION_AOVS(AOV_MEMBER)
};

struct AovRaySetup {
    RAY_SETUP_AOVS(AOV_MEMBER)
};

#undef AOV_MEMBER

#ifdef __cplusplus
#define AOV_SIZE(name, type, channels, nothing) +sizeof(type)
static_assert(sizeof(AovSurface) == 0 SEEN_AOVS(AOV_SIZE), "without padding, as in shaders");
static_assert(sizeof(AovMotion) == 0 MOTION_AOVS(AOV_SIZE), "without padding, as in shaders");
static_assert(sizeof(AovRaySetup) == 0 RAY_SETUP_AOVS(AOV_SIZE), "without padding, as in shaders");
#undef AOV_SIZE
}  // namespace peelray
#endif
#endif
