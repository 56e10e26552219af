// The environment's light without noise (EnvironmentMode::filtered, src/scene/filtered_environment.h): harmonics, behind what is in the
// way of fixed directions, and for rough lobes levels that are blurred as they are. A part of scatter.comp; include after branches.glsl.
#ifndef PEELRAY_FILTERED_LIGHT_GLSL
#define PEELRAY_FILTERED_LIGHT_GLSL

#ifndef SCATTER_FILTERED
vec3 filteredSky(vec3 direction, uint cone, uint medium) { return vec3(0); }
uint countSky(Surface s, Shade shade, SurfaceId from, vec3 front, vec3 behind, inout vec3 sum) { return 0u; }
void emitSky(uint slot, uint count, Surface s, Shade shade, SurfaceId from, vec3 front, vec3 behind, vec3 share, MediaStack media_before, MediaStack media_behind) {}
#else
#include "path/filtered_numbers.h"

uint nextFilteredSize(uint size, uint least) { return size > least ? max(size / 2u, least) : size; }

vec3 filteredLevel(vec2 uv, uint level) {
    uint first = frame[0].filtered_first;
    uvec2 size = frame[0].filtered_size;
    [[dont_unroll]] for (uint i = 0u; i < level; i++) {
        first += size.x * size.y;
        size = uvec2(nextFilteredSize(size.x, 2u * FILTERED_LEAST_ROWS), nextFilteredSize(size.y, FILTERED_LEAST_ROWS));
    }
    return environmentPicture(uv, first - TABLES_END, size);
}

/// What a lobe of this alpha around a direction sees, without the spot that a lamp stands for. Below the first level's alpha the image
/// itself has its part.
vec3 filteredRadiance(vec3 direction, float alpha) {
    const uint last = frame[0].filtered_levels - 1u;
    const float least = exp2(-float(last));
    const vec2 uv = equirectangular(direction);
    if (alpha < least) return mix(skyRadiance(direction, false), filteredLevel(uv, 0u), alpha / least);
    const float level = min(log2(alpha) + float(last), float(last));
    const uint lower = uint(max(level, 0.0));
    return mix(filteredLevel(uv, lower), filteredLevel(uv, min(lower + 1u, last)), level - float(lower));
}

/// The same along a ray of this cone and RayState::medium: chains of mirrors see the image itself, filtered by the cone.
vec3 filteredSky(vec3 direction, uint cone, uint medium) {
    const float spread = unpackCone(cone).y;
    if ((medium & RAY_SEES_SUN) != 0u) return environmentAt(direction, environmentLevelOf(spread));
    return filteredRadiance(direction, alphaOfSpread(spread));
}

/// Where direction `k` of the sample's set is looked up, and behind it its light.
uint fixedDirection(uint k) {
    return frame[0].filtered_directions + 2u * ((params.sample_index % FILTERED_SETS) * FILTERED_DIRECTIONS + k);
}

/// The sky's light as it is to be shared out among the directions: per unit of theirs, times the cosine. Returns what no direction
/// has any share in.
vec3 shareOut(vec3 normal, inout vec3 front, inout vec3 behind) {
    vec3 before = vec3(0), beyond = vec3(0);
    [[dont_unroll]] for (uint k = 0u; k < FILTERED_DIRECTIONS; k++) {
        const uint at = fixedDirection(k);
        const float cosine = dot(lookups[at].xyz, normal);
        before += max(cosine, 0.0) * lookups[at + 1u].rgb;
        if (seeping) beyond += max(-cosine, 0.0) * lookups[at + 1u].rgb;
    }
    const bvec3 none = lessThanEqual(before, vec3(0)), none_beyond = lessThanEqual(beyond, vec3(0));
    vec3 rest = mix(vec3(0), front, none);
    front = mix(front / max(before, vec3(1e-30)), vec3(0), none);
    if (!seeping) return rest;
    rest += mix(vec3(0), behind, none_beyond);
    behind = mix(behind / max(beyond, vec3(1e-30)), vec3(0), none_beyond);
    return rest;
}

/// Of that the light of direction `k`, if nothing but the surface's own triangle `from` is in its way; `seeps`: it comes from behind.
vec3 fixedLight(uint k, Surface s, Shade shade, SurfaceId from, vec3 front, vec3 behind, out vec3 direction, out bool seeps) {
    const uint at = fixedDirection(k);
    direction = lookups[at].xyz;
    const float cosine = dot(direction, s.normal);
    seeps = seeping && cosine < 0.0;
    const vec3 light = lookups[at + 1u].rgb * (seeps ? behind * -cosine : front * max(cosine, 0.0));
    return light == vec3(0) || (!seeps && isBlocked(s, shade, from, direction)) ? vec3(0) : light;
}

/// Shadow rays that the sky's light needs; adds what needs none.
uint countSky(Surface s, Shade shade, SurfaceId from, vec3 front, vec3 behind, inout vec3 sum) {
    sum += shareOut(s.normal, front, behind);
    uint rays = 0u;
    [[dont_unroll]] for (uint k = 0u; k < FILTERED_DIRECTIONS; k++) {
        vec3 direction;
        bool seeps;
        if (fixedLight(k, s, shade, from, front, behind, direction, seeps) != vec3(0)) rays++;
    }
    return rays;
}

/// Puts `count` of them into the queue from `slot` on: as many as were counted, however the compiler rounds a cosine of next to nothing.
void emitSky(uint slot, uint count, Surface s, Shade shade, SurfaceId from, vec3 front, vec3 behind, vec3 share, MediaStack media_before,
             MediaStack media_behind) {
    shareOut(s.normal, front, behind);
    uint emitted = 0u;
    [[dont_unroll]] for (uint k = 0u; k < FILTERED_DIRECTIONS && emitted < count; k++) {
        vec3 direction;
        bool seeps;
        const vec3 light = fixedLight(k, s, shade, from, front, behind, direction, seeps);
        if (light == vec3(0)) continue;
        emitLight(slot + emitted++, lightRay(s, direction, seeps), seeps ? media_behind : media_before, from, light * share);
    }
    [[dont_unroll]] for (; emitted < count; emitted++) emitLight(slot + emitted, lightRay(s, s.normal, false), media_before, from, vec3(0));
}
#endif

#endif
