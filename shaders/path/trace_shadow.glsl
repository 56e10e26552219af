// What the passes that trace the queue of shadow rays share: whatever is in a ray's way takes its light. Bindings
// SHADOW_FIRST_BINDING to SHADOW_FIRST_BINDING + 3. Include after PeelrayRay and PeelrayHit are defined; with SHADOW_THROUGH_GLASS
// also after frame.glsl, with SHADOW_THROUGH_MEDIA after media_walk.glsl and the buffer shadow_media.
#ifndef PEELRAY_TRACE_SHADOW_GLSL
#define PEELRAY_TRACE_SHADOW_GLSL

#include "common/ray.h"
#include "ldc/trace_params.h"
#include "path/path_params.h"

BUFFER_ALIGNED(readonly, SHADOW_FIRST_BINDING + 0, Ray, shadow_rays)
BUFFER(readonly, SHADOW_FIRST_BINDING + 1, SurfaceId, shadow_skip)
BUFFER(, SHADOW_FIRST_BINDING + 2, vec3, shadow_light)
BUFFER(readonly, SHADOW_FIRST_BINDING + 3, uint, queue)

// Defined by the shader that includes this.
/// What the ray hits: the nearest or, with `any`, something; never the surface `skip`.
PeelrayHit traceShadow(PeelrayRay ray, uvec2 skip, bool any);

#if defined(SHADOW_THROUGH_MEDIA) || defined(SHADOW_THROUGH_GLASS)
#include "path/interface.glsl"
#endif

#if defined(SHADOW_THROUGH_MEDIA)
/// Share of the light that arrives along a ray that starts in the media `stack`: the tint of the glass in between, if that is not opaque.
vec3 shadowShare(PeelrayRay ray, uvec2 skip, MediaStack stack, bool opaque_glass) {
    const PeelrayHit unknown = PeelrayHit(0.0, PEELRAY_MISS, PEELRAY_MISS, vec2(0));
    vec3 share = vec3(1);
    for (uint layer = 0u; layer < SHADOW_LAYERS; layer++) {
        const MediaMeeting meeting = mediaFollow(ray, skip, stack, false, unknown);
        const PeelrayHit hit = meeting.hit;
        share *= meeting.at.passed;
        if (hit.triangle == PEELRAY_MISS) return share;
        if (!mayPass(hit.triangle)) return vec3(0);
        const Surface s = meeting.wall ? meeting.surface : surfaceAt(hit.instance, hit.triangle, mediaWeights(ray, hit), ray.direction, 0.0);
        const Material m = materialOf(s);
        const bool clear = transmits(m) && !opaque_glass;
        if (!clear && s.alpha >= 1.0) return vec3(0);
        const Interface face = meeting.wall ? mediaInterface(meeting.at, CHANNEL_MIDDLE) : interfaceInAir(m, s.front, CHANNEL_MIDDLE);
        const vec3 reflected = interfaceReflectance(m, face, clamp(-dot(ray.direction, s.normal), 0.0, 1.0));
        share *= mix(vec3(1), opaque_glass ? vec3(0) : (1.0 - reflected) * transmissionTint(m, s.base_color), s.alpha) * meeting.at.beside;
        const uint medium = meeting.wall ? meeting.at.from : mediaMaterial(meeting.at.before);
        share *= transmittance(medium, layer == 0u ? hit.t : hit.t - ray.tmin);
        if (largest(share) < LEAST_WEIGHT) return vec3(0);
        stack = meeting.wall ? meeting.at.behind : meeting.at.before;
        ray.tmin = meeting.beyond;
        skip = meeting.last;
    }
    return vec3(0);
}
#elif defined(SHADOW_THROUGH_GLASS)
/// Barycentric weights of a hit.
vec2 shadowWeights(PeelrayRay ray, PeelrayHit hit);

/// Share of the light that arrives along the ray: the tint of the glass in between, if that is not opaque.
vec3 shadowShare(PeelrayRay ray, uvec2 skip, bool opaque_glass) {
    vec3 share = vec3(1);
    float since = 0.0;  // the last wall of a volume
    for (uint layer = 0u; layer < SHADOW_LAYERS; layer++) {
        const PeelrayHit hit = traceShadow(ray, skip, false);
        if (hit.triangle == PEELRAY_MISS) return share;
        if (!mayPass(hit.triangle)) return vec3(0);
        const Surface s = surfaceAt(hit.instance, hit.triangle, shadowWeights(ray, hit), ray.direction, 0.0);
        const Material m = materialOf(s);
        const bool clear = transmits(m) && !opaque_glass;
        if (!clear && s.alpha >= 1.0) return vec3(0);
        const bool thin = (m.flags & MATERIAL_THIN) != 0u || !transmits(m);
        const vec3 reflected = interfaceReflectance(m, interfaceInAir(m, s.front, CHANNEL_MIDDLE), clamp(-dot(ray.direction, s.normal), 0.0, 1.0));
        share *= mix(vec3(1), opaque_glass ? vec3(0) : (1.0 - reflected) * transmissionTint(m, s.base_color), s.alpha);
        // Light goes straight on: refraction would make it miss the lamp. Volumes absorb what crosses them.
        if (!thin && !s.front) share *= exp(-m.absorption * (hit.t - since));
        if (!thin) since = hit.t;
        if (largest(share) < LEAST_WEIGHT) return vec3(0);
        ray.tmin = hit.t;
        skip = uvec2(hit.instance, hit.triangle);
    }
    return vec3(0);
}
#endif

/// Traces ray `i` of the queue, which has room for `capacity`.
void shadowRay(uint i, uint capacity) {
    if (i >= min(capacity, queue[QUEUE_LIGHT])) return;
    const Ray stored = shadow_rays[i];
    const PeelrayRay ray = PeelrayRay(stored.origin, stored.tmin, stored.direction, stored.tmax);
    uvec2 skip = uvec2(shadow_skip[i].instance, shadow_skip[i].triangle);
#if defined(SHADOW_THROUGH_MEDIA) || defined(SHADOW_THROUGH_GLASS)
    const bool opaque_glass = (skip.x & SHADOW_OPAQUE_GLASS) != 0u;
    skip.x &= ~SHADOW_OPAQUE_GLASS;
#endif
#ifdef COUNT_FIRST_BINDING
    countNothing();
#endif
#if defined(SHADOW_THROUGH_MEDIA)
    shadow_light[i] *= shadowShare(ray, skip, shadow_media[i], opaque_glass);
#elif defined(SHADOW_THROUGH_GLASS)
    const vec3 share = shadowShare(ray, skip, opaque_glass);
    if (share != vec3(1)) shadow_light[i] *= share;
#else
    if (traceShadow(ray, skip, true).triangle != PEELRAY_MISS) shadow_light[i] = vec3(0);
#endif
#ifdef COUNT_FIRST_BINDING
    countRay(COUNT_SHADOW, 0u, i);
#endif
}

#endif
