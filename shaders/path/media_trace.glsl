// Follows a ray of a queue to the next surface that is one to it, and stores what it meets there. Include after
// media_walk.glsl and the buffers.
#ifndef PEELRAY_MEDIA_TRACE_GLSL
#define PEELRAY_MEDIA_TRACE_GLSL

/// `known`: what the ray hits first is there already.
void mediaTrace(uint i, bool known, uvec2 own) {
    const Ray stored = rays[i];
    const PeelrayRay ray = PeelrayRay(stored.origin, stored.tmin, stored.direction, stored.tmax);
    PeelrayHit first = PeelrayHit(stored.tmax, PEELRAY_MISS, PEELRAY_MISS, vec2(0));
    MediaStack stack = MediaStack(frame[0].camera_media.x, frame[0].camera_media.y);
    if (known) {
        const Hit hit = hits[i];
        first = PeelrayHit(hit.t, hit.triangle, hit.instance, vec2(hit.u, hit.v));
    } else {
        stack = media[i];
    }
    const MediaMeeting m = mediaFollow(ray, own, stack, known, first);
    vec2 weights = m.hit.uv;
    if (m.hit.triangle != PEELRAY_MISS && !m.wall) weights = mediaWeights(ray, m.hit);
    hits[i] = Hit(m.hit.t, m.hit.triangle, m.hit.instance, weights.x, weights.y);
    media_walls[i] = m.at;
    if (media_crowded && !known) atomicAdd(queue[QUEUE_CROWDED], 1u);
}

#endif
