// The baseline: cube maps and shadow maps (src/render/cube_maps, shadow_maps).
#ifndef PEELRAY_CUBEMAP_PARAMS_H
#define PEELRAY_CUBEMAP_PARAMS_H

#include "common/shared.h"

#ifdef __cplusplus
namespace peelray {
#endif

/// An object and, if it reflects or refracts, its probe: the cube map of its surroundings.
struct GpuObject {
    vec3 lower;  ///< its box
    uint probe;  ///< first texel of its cube map; NO_PROBE
    vec3 upper;
    uint face;        ///< texels along a side of the sharpest level's faces
    uint levels;      ///< of roughness: 1 or PROBE_LEVELS
    float thickness;  ///< shortest side of its box: no volume is thicker
};
SHARED_SIZE(GpuObject, 40);
#define NO_PROBE 0xffffffffu
/// Level k is blurred to the roughness (k / (PROBE_LEVELS - 1))² and has faces of max(face >> k, PROBE_SMALLEST_FACE)
/// texels.
#define PROBE_LEVELS 6u
#define PROBE_SMALLEST_FACE 8u

/// One shadow map: a view from a light. A light has six in the table; one without texels is not used.
struct GpuShadowMap {
    vec3 eye;
    uint first;  ///< texel
    vec3 right;  ///< as in Frame
    uint size;   ///< texels along a side; 0: not used
    vec3 up;
    uint orthographic;
    vec3 forward;  ///< unit; the depth is measured along it
};
SHARED_SIZE(GpuShadowMap, 60);

/// Parameters of the rasterisation of probes and shadow maps.
struct MapVisibilityParams {
    uint left_out;  ///< object
    uint shadow;    ///< 1: what casts shadows; 0: what a probe sees
    vec2 jitter;    ///< sample position in the pixel, [0, 1)
};
SHARED_SIZE(MapVisibilityParams, 16);

/// Parameters of the passes that fill a map from `first` on.
struct MapParams {
    uint first;
    uint size;          ///< texels along a side
    uint source_first;  ///< probe_mip: the finer level
    uint source_size;
    float roughness;    ///< probe_filter
    uint sample_index;  ///< probe_store: of the samples that a texel is the mean of
};
SHARED_SIZE(MapParams, 24);

#ifdef __cplusplus
}  // namespace peelray
#endif
#endif
