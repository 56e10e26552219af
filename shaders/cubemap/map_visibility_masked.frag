// map_visibility.frag of scenes with masked materials: apart, since a shader that discards is tested for depth late.
#version 460
#include "common/common.glsl"
#include "cubemap/cubemap_params.h"
PARAMS(MapVisibilityParams)
#include "view/masked_view.glsl"
layout(location = 0) flat in uvec2 surface;
layout(location = 0) out uvec2 color;

void main() {
    if (!fragmentPresent(surface, params.jitter)) discard;
    color = surface;
}
