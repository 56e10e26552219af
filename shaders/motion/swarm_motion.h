// The flight of a body of a swarm, in closed form: one text for C++ and GLSL.
#ifndef PEELRAY_SWARM_MOTION_H
#define PEELRAY_SWARM_MOTION_H

#ifdef __cplusplus
#include <cmath>
#include <glm/glm.hpp>
#define SWARM_FUNCTION inline
namespace peelray {
using glm::mat3;
using glm::vec3;
using uint = glm::uint;
#else
#define SWARM_FUNCTION
#endif

struct SwarmPlace {
    mat3 linear;
    vec3 position;
};

/// A number in [0, 1) from a body's and its own (a permuted congruential generator, O'Neill 2014).
SWARM_FUNCTION float swarmRandom(uint body, uint which) {
    uint x = body * 747796405u + which * 2891336453u + 1u;
    x = ((x >> ((x >> 28u) + 4u)) ^ x) * 277803737u;
    x = (x >> 22u) ^ x;
    x = x * 747796405u + 2891336453u;
    x = ((x >> ((x >> 28u) + 4u)) ^ x) * 277803737u;
    x = (x >> 22u) ^ x;
    return float(x >> 8u) / 16777216.0f;
}

/// A rotation about a unit axis (Rodrigues).
SWARM_FUNCTION mat3 swarmTurn(vec3 axis, float angle) {
#ifdef __cplusplus
    using std::cos;
    using std::sin;
#endif
    const float c = cos(angle), s = sin(angle), d = 1.0f - c;
    return mat3(vec3(c + axis.x * axis.x * d, axis.x * axis.y * d + axis.z * s, axis.x * axis.z * d - axis.y * s),
                vec3(axis.x * axis.y * d - axis.z * s, c + axis.y * axis.y * d, axis.y * axis.z * d + axis.x * s),
                vec3(axis.x * axis.z * d + axis.y * s, axis.y * axis.z * d - axis.x * s, c + axis.z * axis.z * d));
}

/// Where body number `body` is at `phase` of the swarm's period, [0, 1). A body is of radius 1 before it is scaled. It
/// is shot up from the fountain's mouth, falls onto the ground y = 0, bounces with less speed each time, rolls out and
/// shrinks away.
SWARM_FUNCTION SwarmPlace swarmPlace(uint body, float phase) {
#ifdef __cplusplus
    using glm::clamp;
    using std::cos;
    using std::floor;
    using std::sin;
    using std::sqrt;
#endif
    const float life = 6.0f, gravity = 3.6f, mouth = 0.5f, bounce = 0.62f, grip = 0.72f;
    float age = phase + swarmRandom(body, 0u);
    age = (age - floor(age)) * life;
    const float radius = 0.016f + 0.026f * swarmRandom(body, 1u);
    const float around = 6.2831853f * swarmRandom(body, 2u);
    float outward = 0.25f + 0.75f * sqrt(swarmRandom(body, 3u));
    float upward = 1.7f + 1.5f * swarmRandom(body, 4u);
    // The first flight starts at the mouth; later ones start and end on the ground.
    float flight = (upward + sqrt(upward * upward + 2.0f * gravity * (mouth - radius))) / gravity;
    float left = age, height = mouth, distance = 0.1f, spun = 0.0f;
    const float spin = 3.0f + 5.0f * swarmRandom(body, 5u);
    for (uint i = 0u; i < 5u; i++) {
        const float time = left < flight ? left : flight;
        distance += outward * time;
        spun += spin * time * float(5u - i) / 5.0f;
        if (left < flight) {
            height += time * (upward - 0.5f * gravity * time);
            left = -1.0f;
            break;
        }
        left -= flight;
        height = radius;
        upward = bounce * (gravity * flight - upward);
        outward *= grip;
        flight = 2.0f * upward / gravity;
    }
    if (left >= 0.0f) {
        // It rolls, slower and slower.
        const float rolled = outward * 0.5f * (1.0f - 1.0f / (1.0f + 2.0f * left));
        distance += rolled;
        spun += rolled / radius;
    }
    const float grown = clamp(age / 0.15f, 0.0f, 1.0f) * clamp((life - age) / 0.5f, 0.0f, 1.0f);
    const float z = 2.0f * swarmRandom(body, 6u) - 1.0f, phi = 6.2831853f * swarmRandom(body, 7u);
    const float level = sqrt(1.0f - z * z < 0.0f ? 0.0f : 1.0f - z * z);
    SwarmPlace place;
    place.linear = swarmTurn(vec3(level * cos(phi), z, level * sin(phi)), spun) * (radius * grown);
    place.position = vec3(distance * cos(around), height, distance * sin(around));
    return place;
}

#ifdef __cplusplus
}  // namespace peelray
#endif
#endif
