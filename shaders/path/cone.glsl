// Ray cones: how wide the light is that a ray stands for (Akenine-Möller et al.: Improved Shader and Texture Level of Detail Using
// Ray Cones, JCGT 2021). A cone is its width, negative behind a focus, and how much wider it gets per world unit.
#ifndef PEELRAY_CONE_GLSL
#define PEELRAY_CONE_GLSL

/// The upper halves of both numbers, rounded: they are right to 0.4 %, which no level of a texture shows.
uint packCone(vec2 cone) {
    const uvec2 bits = floatBitsToUint(cone) + 0x8000u;
    return (bits.x & 0xffff0000u) | bits.y >> 16u;
}
vec2 unpackCone(uint packed) { return uintBitsToFloat(uvec2(packed & 0xffff0000u, packed << 16u)); }

/// The cone where its ray has gone the distance `t`.
vec2 coneAt(vec2 cone, float t) { return vec2(cone.x + t * cone.y, cone.y); }

/// After a surface of this curvature: the mirrored direction turns twice as far as the normal, ...
vec2 coneReflected(vec2 cone, float curvature) { return vec2(cone.x, cone.y + 2.0 * curvature * cone.x); }
/// ... the refracted one as Snell's law has it near the normal.
vec2 coneRefracted(vec2 cone, float curvature, float eta) {
    const float turn = curvature * cone.x;
    return vec2(cone.x, (cone.y + turn) / eta - turn);
}


/// After a lobe of this alpha. Half of what GGX reflects is within atan(alpha) of the mean microfacet, and so within twice that of the mean
/// direction; the cone is as wide. Both blur, and a focus is lost.
vec2 coneBlurred(vec2 cone, float alpha) {
    const float spread = sqrt(cone.y * cone.y + 16.0 * alpha * alpha);
    return vec2(cone.x, cone.x < 0.0 ? -spread : spread);
}
/// Of a lobe as wide as a cone that grows by `spread`.
float alphaOfSpread(float spread) { return 0.25 * abs(spread); }

#endif
