// What a ray meets where media may overlap or touch: the next surface that is a surface to it. Walls at which the medium
// stays the same are passed, and walls that coincide are one wall, whatever the order in which they are found. Include
// after frame.glsl, media.glsl and peelray/ray.glsl.
#ifndef PEELRAY_MEDIA_WALK_GLSL
#define PEELRAY_MEDIA_WALK_GLSL

// Defined by the shader that includes this.
/// What the ray hits first, not the surface `skip`; not what mediaForget() was told of, where MEDIA_FORGETS says so.
PeelrayHit mediaNearest(PeelrayRay ray, uvec2 skip);
/// The instance's triangle does not count any more for this ray.
void mediaForget(uint instance, uint triangle);
/// Barycentric weights of a hit.
vec2 mediaWeights(PeelrayRay ray, PeelrayHit hit);

struct MediaMeeting {
    PeelrayHit hit;
    Surface surface;    ///< of walls
    bool wall;          ///< of a medium; else of what is below only `before`, `behind` and `passed` have a meaning
    MediaWall at;
    float beyond;       ///< where a ray that goes straight on meets the next surface at the earliest,
    uvec2 last;         ///< and instance and triangle that it must not meet
};

/// Walls that coincide.
struct MediaGroup {
    uint count;
    PeelrayHit hits[WALLS_TOGETHER];
    uint materials[WALLS_TOGETHER];
    bool enters[WALLS_TOGETHER];
    vec3 tints[WALLS_TOGETHER];
};

vec3 mediaTint(Surface s) { return transmissionTint(materialOf(s), s.base_color); }

/// How far along a ray walls count as one with the wall `s`, which it meets at `t`.
float mediaReach(Surface s, float t, vec3 direction) {
    const float slope = max(abs(dot(s.geometric, direction)), LEAST_COSINE);
    return s.error * (WALLS_APART / POSITION_ROUNDING) / slope + t * DISTANCE_ROUNDING + min(s.offset / slope, FLATTEST_START * s.offset);
}

/// Adds a wall; false: it is not one with the others. One body's wall may be hit twice where triangles meet, and counts
/// once; a ray does not leave a body where it enters it.
bool mediaAdd(inout MediaGroup group, PeelrayHit hit, Surface s, MediaStack before) {
    for (uint k = 0u; k < group.count; k++) {
        if (group.materials[k] != s.material) continue;
        if (group.enters[k] == s.front) return true;
        if (!mediaHold(before, mediaRank(s.material))) return false;
    }
    group.hits[group.count] = hit;
    group.materials[group.count] = s.material;
    group.enters[group.count] = s.front;
    group.tints[group.count] = mediaTint(s);
    group.count++;
    return true;
}

/// What the group is to a ray in the media `before`: rays enter what they enter before they leave what they leave. A
/// medium that is left without having been entered (an open sheet) was there. Returns the wall that counts: of the two
/// media at it, that of the lower rank.
uint mediaMeet(MediaGroup group, MediaStack before, inout MediaWall at) {
    MediaStack assumed = before;
    for (uint k = 0u; k < group.count; k++)
        if (!group.enters[k] && !mediaHold(before, mediaRank(group.materials[k]))) assumed = mediaEnter(assumed, mediaRank(group.materials[k]));
    at.behind = assumed;
    for (uint k = 0u; k < group.count; k++)
        if (group.enters[k]) at.behind = mediaEnter(at.behind, mediaRank(group.materials[k]));
    for (uint k = 0u; k < group.count; k++)
        if (!group.enters[k]) at.behind = mediaLeave(at.behind, mediaRank(group.materials[k]));
    at.from = mediaMaterial(assumed);
    at.to = mediaMaterial(at.behind);
    uint owner = 0u, least = MEDIA_NO_RANK;
    for (uint k = 0u; k < group.count; k++) {
        const uint material = group.materials[k], rank = mediaRank(material);
        // The wall of a body within another one of the same medium has no colour.
        if (min(mediaDepth(assumed, rank), mediaDepth(at.behind, rank)) > 0u) group.tints[k] = vec3(1);
        if ((material != at.from && material != at.to) || rank >= least) continue;
        owner = k;
        least = rank;
    }
    at.beside = vec3(1);
    for (uint k = 0u; k < group.count; k++)
        if (k != owner || at.from == at.to) at.beside *= group.tints[k];
    return owner;
}

/// Where to look for walls that coincide with the hit on `s`.
PeelrayRay mediaNear(PeelrayRay ray, PeelrayHit hit, Surface s) {
    const float reach = mediaReach(s, hit.t, ray.direction);
    return PeelrayRay(ray.origin, max(ray.tmin, hit.t - reach), ray.direction, hit.t + reach);
}

/// Is the hit a wall of a medium?
bool mediaIsWall(PeelrayHit hit) {
    return hit.triangle != PEELRAY_MISS && mediaRank(triangle_materials[hit.triangle]) != MEDIA_NO_RANK;
}

/// The group is complete: what the ray meets there.
void mediaClose(MediaGroup group, PeelrayRay ray, inout MediaMeeting m) {
    const uint owner = mediaMeet(group, m.at.before, m.at);
    if (m.surface.offset > 0.0) m.beyond = max(m.beyond, m.hit.t + mediaReach(m.surface, m.hit.t, ray.direction));
    if (group.count == 1u || m.at.from == m.at.to) return;
    float error = m.surface.error;
    if (owner != 0u) {
        m.hit = group.hits[owner];
        m.hit.uv = mediaWeights(ray, m.hit);
        m.surface = surfaceAt(m.hit.instance, m.hit.triangle, m.hit.uv, ray.direction, 0.0);
        error = max(error, m.surface.error);
    }
    m.at.lift = error * (WALLS_APART / POSITION_ROUNDING) * WALLS_LIFT;
}

/// What a ray in the media `media` meets, which does not hit the surface `skip`. `known`: what it hits first is `first`.
/// What is opaque hides walls that coincide with it: glass stands on a table without air in between.
/// Rays are traced in one place, for the sake of what compiles it: looking for the next wall and for those that coincide
/// with it take turns.
MediaMeeting mediaFollow(PeelrayRay ray, uvec2 skip, MediaStack media, bool known, PeelrayHit first) {
    MediaMeeting m;
    m.wall = false;
    m.last = skip;
    m.at = MediaWall(media, media, MEDIUM_NONE, MEDIUM_NONE, vec3(1), 0.0, vec3(1));
    MediaGroup group;
    group.count = 0u;
    PeelrayRay near = ray;
    for (uint passed = 0u, looked = 0u;; looked++) {
        PeelrayHit hit = first;
        if (!known) hit = mediaNearest(near, m.last);
        known = false;
        const bool wall = mediaIsWall(hit);
        if (wall) hit.uv = mediaWeights(ray, hit);
        Surface here;
        if (wall || (group.count > 0u && hit.triangle != PEELRAY_MISS))
            here = surfaceAt(hit.instance, hit.triangle, wall ? hit.uv : vec2(0), ray.direction, 0.0);
        if (group.count == 0u) {
            m.hit = hit;
            m.beyond = hit.t;
            m.last = uvec2(hit.instance, hit.triangle);
            m.wall = wall;
            if (!wall) return m;
            m.surface = here;
            mediaAdd(group, hit, m.surface, m.at.before);
            near = mediaNear(ray, hit, m.surface);
            looked = 0u;
            mediaForget(hit.instance, hit.triangle);
            continue;
        }
        if (hit.triangle != PEELRAY_MISS) {
            const bool parallel = abs(dot(here.geometric, m.surface.geometric)) >= WALLS_PARALLEL;
            if (!wall && parallel && !mayPass(hit.triangle)) {
                m.hit = hit;
                m.wall = false;
                return m;
            }
            if (wall && parallel && mediaAdd(group, hit, here, m.at.before)) {
                m.beyond = max(m.beyond, hit.t);
                m.last = uvec2(hit.instance, hit.triangle);
                if (!MEDIA_FORGETS) near.tmin = hit.t;
                mediaForget(hit.instance, hit.triangle);
                if (group.count < WALLS_TOGETHER && looked < 2u * WALLS_TOGETHER) continue;
            }
        }
        mediaClose(group, ray, m);
        if (m.at.from != m.at.to || passed >= WALLS_PASSED) return m;
        passed++;
        m.at.passed *= m.at.beside;
        m.at.beside = vec3(1);
        m.at.before = m.at.behind;
        group.count = 0u;
        ray.tmin = m.beyond;
        near = ray;
    }
}

#endif
