// Sends photons from the lamps towards what mirrors or refracts. Each lamp gets its share of them by systematic sampling, and each of
// its targets by the solid angle that it fills; where targets overlap, photons are as much weaker as they are more.
#version 460
#extension GL_EXT_control_flow_attributes : require
#include "common/common.glsl"
#include "caustics/photon_params.h"
#include "common/ray.h"
#include "path/frame.h"
layout(local_size_x = 64) in;
PARAMS(PhotonEmitParams)
BUFFER(readonly, 0, GpuLight, lights)
BUFFER(readonly, 1, PhotonLamp, photon_lamps)
BUFFER(readonly, 2, PhotonTarget, photon_targets)
BUFFER(readonly, 3, uint, photon_thresholds)
BUFFER(writeonly, 4, Ray, rays)
BUFFER(writeonly, 5, SurfaceId, skip)
BUFFER(writeonly, 6, PhotonState, photon_states)
BUFFER(writeonly, 7, Photon, photons)
#include "path/ball.glsl"
#include "path/random.glsl"

vec2 randomAt(uint i, uint purpose) { return randomPair(params.seed, 0u, i, params.bits, purpose, params.picture); }

/// The first lamp before whose threshold photon `i` lies. In integers, so that the reference finds the same.
uint lampOf(uint i) {
    uint first = 0u, last = params.lamps - 1u;
    [[dont_unroll]] while (first < last) {
        const uint middle = (first + last) / 2u;
        uint high, low;
        umulExtended(photon_lamps[middle].threshold, params.count, high, low);
        if (high > i || (high == i && low > params.offset))
            last = middle;
        else
            first = middle + 1u;
    }
    return first;
}

/// The target of a lamp that a number in [0, 1) chooses; what is left of it chooses where.
uint targetOf(uint first_threshold, inout float random) {
    const uint number = uint(random * 16777216.0) << 8;
    uint first = 0u, last = params.targets - 1u;
    [[dont_unroll]] while (first < last) {
        const uint middle = (first + last) / 2u;
        if (photon_thresholds[first_threshold + middle] > number)
            last = middle;
        else
            first = middle + 1u;
    }
    const uint before = first > 0u ? photon_thresholds[first_threshold + first - 1u] : 0u;
    random = min(float(number - before) / float(photon_thresholds[first_threshold + first] - before), 0.99999994);
    return first;
}

/// Does the ray meet the target's ball, grown by a radius?
bool meets(PhotonTarget target, float grown, vec3 origin, vec3 direction, bool line) {
    const vec3 way = target.centre - origin;
    const float radius = target.radius + grown;
    if (!line && dot(way, direction) <= 0.0 && dot(way, way) > radius * radius) return false;
    const vec3 beside = cross(way, direction);
    return dot(beside, beside) <= radius * radius;
}

/// Weights of all targets that the ray meets; the one that it was aimed at is among them whatever rounding says.
float sharesMet(uint aimed, float grown, vec3 origin, vec3 direction, bool line) {
    float sum = photon_targets[aimed].share;
    for (uint k = 0u; k < params.targets; k++)
        if (k != aimed && meets(photon_targets[k], grown, origin, direction, line)) sum += photon_targets[k].share;
    return sum;
}

/// A unit direction evenly from those to a ball.
vec3 directionInto(PhotonTarget target, float grown, vec3 origin, vec2 random) {
    const vec3 way = target.centre - origin;
    const float distance = length(way), radius = target.radius + grown;
    if (distance <= radius) {
        const float height = 1.0 - 2.0 * random.x, across = sqrt(max(0.0, 1.0 - height * height)), phi = 2.0 * PI * random.y;
        return vec3(across * cos(phi), across * sin(phi), height);
    }
    return directionInCone(way / distance, radius / distance, random);
}

vec3 onDisc(vec3 normal, float radius, vec2 random) {
    vec3 t, b;
    tangents(normal, t, b);
    const float r = radius * sqrt(random.x), phi = 2.0 * PI * random.y;
    return t * (r * cos(phi)) + b * (r * sin(phi));
}

void main() {
    const uint i = GLOBAL_INDEX;
    if (i >= params.count) return;
    const PhotonLamp lamp = photon_lamps[lampOf(i)];
    const GpuLight light = lights[lamp.light];
    vec2 random = randomAt(i, RANDOM_PHOTON_TARGET);
    const uint aimed = targetOf(lamp.first, random.x);
    const PhotonTarget target = photon_targets[aimed];
    const bool soft = params.soft != 0u && light.sine > 0.0;
    const vec2 place = soft ? randomAt(i, RANDOM_PHOTON_LAMP) : vec2(0);
    vec3 origin, direction, flux = light.color * lamp.weight;
    if (light.kind == 0u) {
        float share = 1.0;
        direction = soft ? -directionToBall(-light.direction, light.sine, place, share) : light.direction;
        origin = target.centre + onDisc(direction, target.radius, random);
        flux *= share / sharesMet(aimed, 0.0, origin, direction, true);
        // From before the scene.
        origin -= direction * (dot(origin - params.centre, direction) + params.reach);
    } else {
        // A ball that is as bright all over sends as much through each point of its disc.
        const float radius = soft ? light.sine : 0.0;
        direction = directionInto(target, radius, light.position, random);
        origin = light.position;
        flux /= sharesMet(aimed, radius, origin, direction, false);
        if (soft) {
            const vec3 off = onDisc(direction, radius, place);
            origin += off + direction * sqrt(max(0.0, radius * radius - dot(off, off)));
        }
        if (light.kind == 2u) {
            const float cone = clamp(dot(light.direction, direction) * light.cone_scale + light.cone_offset, 0.0, 1.0);
            flux *= cone * cone;
        }
    }
    const bool none = flux == vec3(0);
    rays[i] = Ray(origin, 0.0, none ? vec3(0) : direction, uintBitsToFloat(0x7f800000u));
    skip[i] = SurfaceId(NO_TRIANGLE, NO_TRIANGLE);
    photon_states[i] = PhotonState(flux, MEDIUM_NONE, 0.0, 0u, lamp.light);
    photons[i] = Photon(vec3(0), vec3(0), vec3(0), vec3(0));
}
