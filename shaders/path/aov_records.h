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
    float seen;  ///< 1: there is a surface
    SURFACE_AOVS(AOV_MEMBER)
};

struct AovRaySetup {
    RAY_SETUP_AOVS(AOV_MEMBER)
};

#undef AOV_MEMBER

#ifdef __cplusplus
#define AOV_SIZE(name, type, channels, nothing) +sizeof(type)
static_assert(sizeof(AovSurface) == sizeof(float) SURFACE_AOVS(AOV_SIZE), "without padding, as in shaders");
static_assert(sizeof(AovRaySetup) == 0 RAY_SETUP_AOVS(AOV_SIZE), "without padding, as in shaders");
#undef AOV_SIZE
}  // namespace peelray
#endif
#endif
