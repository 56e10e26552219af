// Directions to a ball, or to a disc in the sky. Include after shading.glsl.
#ifndef PEELRAY_BALL_GLSL
#define PEELRAY_BALL_GLSL

#include "path/shading.glsl"

/// Evenly from the cone around `centre` whose half angle has this sine; `random` in [0, 1).
vec3 directionInCone(vec3 centre, float sine, vec2 random) {
    const float farthest = sqrt(max(0.0, 1.0 - sine * sine));
    const float off = random.x * sine * sine / (1.0 + farthest), flat_part = sqrt(off * (2.0 - off)), phi = 2.0 * PI * random.y;
    vec3 t, b;
    tangents(centre, t, b);
    return normalize(centre * (1.0 - off) + t * (flat_part * cos(phi)) + b * (flat_part * sin(phi)));
}

/// A direction to a ball; `share`: of the irradiance that would arrive if all came from its centre, times the cosine's mean. Shirley, Wang
/// and Zimmerman 1996.
vec3 directionToBall(vec3 centre, float sine, vec2 random, out float share) {
    share = 2.0 / (1.0 + sqrt(max(0.0, 1.0 - sine * sine)));  // the cone's solid angle over that of its projection, which lights what faces it
    return directionInCone(centre, sine, random);
}

#endif
