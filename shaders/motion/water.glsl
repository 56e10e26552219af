// Heights of a water surface. Include after the parameters (WaterParams) and the buffers heights and velocities.
#ifndef PEELRAY_WATER_GLSL
#define PEELRAY_WATER_GLSL

/// In the moment, at a vertex.
float waterHeight(uint x, uint z) {
    const uint i = z * (params.cells + 1u) + x;
    return heights[i] + params.rest * velocities[i];
}

/// Bilinear, at a place in metres.
float waterHeight(vec2 p) {
    const vec2 q = clamp((p / params.size + 0.5) * float(params.cells), vec2(0), vec2(float(params.cells)));
    const uvec2 i = min(uvec2(q), uvec2(params.cells - 1u));
    const vec2 f = q - vec2(i);
    return mix(mix(waterHeight(i.x, i.y), waterHeight(i.x + 1u, i.y), f.x), mix(waterHeight(i.x, i.y + 1u), waterHeight(i.x + 1u, i.y + 1u), f.x), f.y);
}

#endif
