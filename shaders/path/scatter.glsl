// Shades a hit: what it emits by itself, the next level's rays for what it reflects and lets through, shadow rays for the light that
// may reach it, and the tree's node. Misses see the environment. The camera's level makes its rays itself, from what the pixels see.
// With SCATTER_DRAWN light is drawn as well: a shader of its own, since compiling what is not needed takes seconds on a CPU.
#include "common/common.glsl"
#include "common/ray.h"
#include "path/frame.h"
#include "path/media_params.h"
#include "path/path_params.h"
#include "view/view_params.h"
layout(local_size_x = 64) in;
layout(constant_id = 0) const bool camera = false;     // level 0
layout(constant_id = 1) const bool by_number = false;  // see seen.glsl
layout(constant_id = 2) const bool layered = false;    // media may overlap or touch: all rays were traced by trace_media
#ifdef SCATTER_FILTERED
const bool env_filtered = true, env_sampled = false;  // the environment's light is found without noise
const uint sampled = 0u;
#else
const bool env_filtered = false;
layout(constant_id = 7) const uint sampled = 2u;         // EFFECT_SAMPLED, or 2: the frame says so
#endif
#ifdef SCATTER_DRAWN
#ifndef SCATTER_FILTERED
layout(constant_id = 3) const bool env_sampled = false;  // the environment's light is found by sampling
#endif
layout(constant_id = 4) const bool indirect = false;     // diffuse bounces are followed
layout(constant_id = 5) const bool emitting = false;     // light is looked for on emissive triangles
layout(constant_id = 6) const bool many_lamps = false;   // one of them is drawn
layout(constant_id = 8) const bool soft_lamps = false;   // some have a size, and lobes are sampled
layout(constant_id = 9) const uint photons = 0u;         // PHOTONS_*: that lamps send
bool after_scattering = false;                           // the thread's hit is seen by what scatters, and photons bring what is mirrored there
#define LOBES_BROUGHT after_scattering
#else
const uint photons = 0u;
#ifndef SCATTER_FILTERED
const bool env_sampled = false;
#endif
const bool indirect = false, emitting = false, many_lamps = false, soft_lamps = false;
#endif
PARAMS(LevelParams)
#define SCENE_FIRST_BINDING 0
#define SCENE_WITH_TRIANGLES
#include "path/scene_buffers.glsl"
BUFFER(readonly, 12, Ray, rays)
BUFFER(readonly, 13, RayState, states)
BUFFER(readonly, 14, Hit, hits)
BUFFER(writeonly, 15, PathNode, nodes)
BUFFER(, 16, uint, queue)
BUFFER(writeonly, 17, Ray, next_rays)
BUFFER(writeonly, 18, RayState, next_states)
BUFFER(writeonly, 19, SurfaceId, next_skip)
BUFFER(writeonly, 20, PathBranches, branches)
BUFFER(readonly, 21, GpuLight, lights)
BUFFER(writeonly, 22, Ray, shadow_rays)
BUFFER(writeonly, 23, SurfaceId, shadow_skip)
BUFFER(writeonly, 24, vec3, shadow_light)
BUFFER(readonly, 25, uvec2, visibility)
BUFFER(readonly, 26, GpuDraw, draws)
BUFFER(readonly, 28, MediaWall, media_walls)
BUFFER(readonly, 29, uint, media_ranks)
BUFFER(writeonly, 30, MediaStack, next_media)
BUFFER(writeonly, 31, MediaStack, shadow_media)  // the last: some devices bind no more than 32 in a stage
#include "path/frame.glsl"
#include "path/media.glsl"
#include "path/branches.glsl"
#include "path/backdrop.glsl"
#include "path/emitters.glsl"
#include "view/camera.glsl"
#include "view/camera_hit.glsl"
#include "view/seen.glsl"
#include "view/camera_start.glsl"
#include "common/last_group.glsl"

shared uint group_counts[5];  // of the workgroup: reflection, refraction, shadow rays; of them the sky's; diffuse
shared uint group_cut[2];     // reflection, refraction that the last level cuts off
shared uint group_coats;      // of the refractions those that clear coats mirror
shared uint group_first;
shared uint group_first_light;

bool samplesMicrofacets() { return sampled < 2u ? sampled == 1u : (frame[0].effects & EFFECT_SAMPLED) != 0u; }

vec2 randomAt(uint seed, uint purpose) {
    return randomPair(seed, params.level, params.sample_index, frame[0].sample_bits, purpose, frame[0].seed);
}

vec3 filteredSky(vec3 direction, uint cone, uint medium);
bool blursCones() { return env_filtered; }

/// What rays of lobes bring counts by the balance heuristic, since light is also found otherwise. What sees a sharp image of the
/// environment sees it filtered by its cone: the sun's disc in a curved coat would be noise.
vec3 environmentSeen(vec3 direction, float blur, float density, uint cone, uint medium) {
    if (env_filtered) return indirect && density < 0.0 ? vec3(0) : filteredSky(direction, cone, medium);
    if (!env_sampled) return environmentRadiance(direction, blur);
    if (indirect && density < 0.0) return vec3(0);
    if (density == 0.0) return environmentAt(direction, environmentLevelOf(unpackCone(cone).y));
    return environmentAt(direction, 0.0) * (density / (density + environmentDensity(direction)));
}

/// On a miss.
vec3 skyAlong(Ray ray, RayState state) {
    const bool sees_sun = (state.medium & RAY_SEES_SUN) != 0u;
    if (!env_sampled && !env_filtered) return skyRadiance(ray.direction, sees_sun);
    return environmentSeen(ray.direction, 0.0, state.density, state.cone, state.medium) + (sees_sun ? sunDisc(ray.direction) : vec3(0));
}

/// The half vector: the mean one for mirrors and with one sample per pixel, else a sample of the visible normals.
vec3 microfacet(Lobe lobe, vec3 view, uint seed, uint purpose) {
    if (!isSampled(lobe)) return meanMicrofacet(lobe, view);
    return sampleMicrofacet(lobe, view, randomAt(seed, purpose));
}

/// Part of the rough lobe that is traced; the rest sees the blurred environment. One sample cannot follow a wide lobe.
float tracedPart(float roughness, float metallic) {
    if (env_sampled || env_filtered) return 1.0;
    if (samplesMicrofacets()) return roughness < TRACED_ROUGHNESS || metallic > MOSTLY_METAL ? 1.0 : 0.0;
    return 1.0 - smoothstep(FADE_FIRST_ROUGHNESS, FADE_LAST_ROUGHNESS, roughness);
}

/// Has the ray come as far as it is followed? Without blended surfaces and diffuse bounces its level is its bounces.
bool isLast(RayState state, bool passes) {
    if (indirect && params.level >= frame[0].last_level) return true;
    const uint levels = params.level - (indirect ? state.scattered : 0u);
    if (!blended || passes) return levels >= frame[0].bounce_levels;
    return levels >= min(frame[0].bounce_levels, frame[0].bounces + (state.medium & RAY_PASSES) / RAY_PASSED);
}

/// Is it bright enough, and its effect on?
bool isWanted(Branch branch, RayState state) {
    return (frame[0].effects & branch.effect) != 0u && largest(branch.weight * state.weight) >= LEAST_WEIGHT;
}

void decide(inout Branch branch, RayState state, bool passes) { branch.traced = isWanted(branch, state) && !isLast(state, passes); }

/// Would it be traced if it were not too far along its path? With --bounces 0 nobody asked for it.
bool isCut(Branch branch, RayState state, bool passes) {
    return frame[0].bounces > 0u && params.level > 0u && isWanted(branch, state) && isLast(state, passes);
}

/// `path_weight`: of the pixel's light that comes along the new ray; `scattered`: diffuse bounces up to it.
void emitRay(uint index, Branch branch, MediaStack stack, Surface s, SurfaceId from, vec3 path_weight, uint seed, uint scattered) {
    if (index >= params.next_capacity) return;
    if (layered) next_media[index] = stack;
    const float infinity = uintBitsToFloat(0x7f800000u);
    next_rays[index] = leavingRay(s, s.position, branch.direction, infinity);
    next_states[index] = RayState(path_weight, branch.medium, seed, branch.cone, branch.density, scattered);
    next_skip[index] = from;
}

/// A ray to a light far away that the surface faces; `seeps`: from its other side.
Ray lightRay(Surface s, vec3 direction, bool seeps) {
    const float infinity = uintBitsToFloat(0x7f800000u);
    return seeps ? leavingRay(s, s.position, direction, infinity) : shadowRay(s, direction, infinity);
}

#include "path/ignores_light.glsl"
#include "path/light_rays.glsl"

/// The surface that a shadow ray to a lamp starts on; glass is opaque to the ray where photons go through it.
SurfaceId lampFrom(SurfaceId from) {
    return SurfaceId(photons == PHOTONS_THROUGH_GLASS ? from.instance | SHADOW_OPAQUE_GLASS : from.instance, from.triangle);
}

void emitLight(uint index, Ray ray, MediaStack stack, SurfaceId from, vec3 light) {
    if (index >= params.light_capacity) return;
    if (layered) shadow_media[index] = stack;
    shadow_rays[index] = ray;
    shadow_skip[index] = from;
    shadow_light[index] = light;
}

/// Is the surface's own triangle `from` in the way of a light?
bool isBlocked(Surface s, Shade shade, SurfaceId from, vec3 direction) {
    return (frame[0].effects & EFFECT_SHADOW) != 0u && !lightSeeps(s, shade, direction) && blocksItself(s, from, direction);
}

/// Light of lamp `index`, if nothing but the surface's own triangle `from` is in its way.
vec3 arrivingLight(uint index, Surface s, Material m, Shade shade, vec3 view, SurfaceId from, uint seed, out vec3 direction) {
    vec2 random = vec2(0);
    const bool soft = soft_lamps && lights[index].sine > 0.0;
    if (soft) random = randomAt(seed, RANDOM_LAMP + index);
    const vec3 light = lampLight(index, s, m, shade, view, soft, random, direction);
    return light == vec3(0) || !isBlocked(s, shade, from, direction) ? light : vec3(0);
}

/// One direction for the light that the surface scatters from all around. `inside`: medium behind the surface.
Branch diffuseBranch(Surface s, Material m, Shade shade, vec3 view, RayState state, vec2 cone, uint inside) {
    Branch branch = NO_BRANCH;
    if (state.scattered >= frame[0].gi || params.level >= frame[0].last_level || !scattersLight(m)) return branch;
    const float behind = shareBehind(m);
    vec3 direction = scatteredDirection(s, behind, randomAt(state.seed, RANDOM_DIFFUSE));
    const float density = scatteredDensity(s, behind, direction);
    if (density <= 0.0) return branch;
    const vec3 weight = scatteredShare(s, m, shade, view, direction) * (s.alpha / density);
    const bool back = dot(s.normal, direction) < 0.0;
    direction = back ? -aboveSurface(-direction, s.geometric) : aboveSurface(direction, s.geometric);
    // What is scattered is blurred: it may show textures as coarse as that.
    branch = branchAlong(weight, direction, back ? inside : state.medium & ~RAY_SEES_SUN, keptCone(vec2(cone.x, 1.0)), 0u, -1.0);
    branch.traced = largest(weight * state.weight) >= LEAST_WEIGHT;
    return branch;
}

#include "path/drawn_light.glsl"
#include "path/filtered_light.glsl"

/// The light that no ray is to be traced for. `sky`: the sky's is wanted; `rays`: how many shadow rays the rest needs, of them `sky_rays`
/// to the sky; `found`: what is drawn for some of them.
vec3 unshadowedLight(Surface s, Material m, Shade shade, vec3 view, SurfaceId from, RayState state, bool sky, out uint rays, out uint sky_rays, out DrawnLight found) {
    rays = sky_rays = 0u;
    found = NO_DRAWN_LIGHT;
    vec3 sum = vec3(0);
    for (uint k = 0u; k < frame[0].lights; k++) {
        vec3 direction;
        const vec3 light = arrivingLight(lampIndex(k), s, m, shade, view, from, state.seed, direction);
        if (light == vec3(0)) continue;
        if ((frame[0].effects & EFFECT_SHADOW) != 0u)
            rays++;
        else
            sum += light;
    }
    if (env_sampled) {
        found.environment = environmentLight(s, m, shade, view, randomAt(state.seed, RANDOM_ENVIRONMENT));
        sum += unlessTraced(found.environment, s, shade, from, rays);
    }
    if (many_lamps) {
        drawLamp(s, m, shade, view, from, state.seed, found);
        sum += unlessTraced(found.lamp, s, shade, from, rays);
    }
    if (emitting) {
        const bool followed = (frame[0].effects & EFFECT_REFLECTION) != 0u && !isLast(state, false);
        found.emitter = emitterLight(s, m, shade, view, from, followed, randomAt(state.seed, RANDOM_EMITTER).x, randomAt(state.seed, RANDOM_EMITTER_POINT), found.reach);
        sum += unlessTraced(found.emitter, s, shade, from, rays);
    }
    if (env_sampled || !sky) return sum;
    vec3 front, behind;
    skyLight(s, m, shade, view, front, behind);
    if ((frame[0].effects & EFFECT_AMBIENT) == 0u) return sum + front + behind;
    if (env_filtered)
        sky_rays = countSky(s, shade, from, front, behind, sum);
    else
        sky_rays = (front != vec3(0) ? 1u : 0u) + (behind != vec3(0) ? 1u : 0u);
    rays += sky_rays;
    return sum;
}

/// Puts the shadow rays that unshadowedLight() counted into the queue from `slot` to `end`; `share`: of their light that gets through to where
/// the hit is seen from; `before`, `behind`: the media on either side.
void emitLights(uint slot, uint end, Surface s, Material m, vec3 view, vec3 share, DrawnLight found, bool sky, MediaStack before, MediaStack behind, SurfaceId from, uint seed) {
    if (!transmits(m)) behind = before;  // here the wall lets nothing but diffuse light through
    const Shade shade = shadeOf(s, m, view);
    if ((frame[0].effects & EFFECT_SHADOW) != 0u) {
        for (uint k = 0u; k < frame[0].lights; k++) {
            vec3 direction;
            const uint index = lampIndex(k);
            const vec3 light = arrivingLight(index, s, m, shade, view, from, seed, direction);
            const bool seeps = lightSeeps(s, shade, direction);
            if (light != vec3(0)) emitLight(slot++, lampRay(index, s, direction, seeps), seeps ? behind : before, lampFrom(from), light * share);
        }
        if (many_lamps && found.lamp.light != vec3(0)) {
            const bool seeps = lightSeeps(s, shade, found.lamp.direction);
            emitLight(slot++, lampRay(found.lamp_index, s, found.lamp.direction, seeps), seeps ? behind : before, lampFrom(from), found.lamp.light * share);
        }
        if (env_sampled && found.environment.light != vec3(0)) {
            const bool seeps = lightSeeps(s, shade, found.environment.direction);
            emitLight(slot++, lightRay(s, found.environment.direction, seeps), seeps ? behind : before, from, found.environment.light * share);
        }
        if (emitting && found.emitter.light != vec3(0)) {
            const bool seeps = lightSeeps(s, shade, found.emitter.direction);
            Ray ray = lightRay(s, found.emitter.direction, seeps);
            // Not as far as the emitter itself.
            ray.tmax = dot(s.position - ray.origin + found.emitter.direction * found.reach, found.emitter.direction) * (1.0 - EMITTER_GAP);
            emitLight(slot++, ray, seeps ? behind : before, from, found.emitter.light * share);
        }
    }
    if (env_sampled || !sky || (frame[0].effects & EFFECT_AMBIENT) == 0u) return;
    vec3 front, back;
    skyLight(s, m, shade, view, front, back);
    if (env_filtered) {
        emitSky(slot, end - slot, s, shade, from, front, back, share, before, behind);
        return;
    }
    if (front != vec3(0)) emitLight(slot++, skyRay(s, seed, false), before, from, front * share);
    if (back != vec3(0)) emitLight(slot, skyRay(s, seed, true), behind, from, back * share);
}

/// Makes room in the queues for the rays of the workgroup.
void reserve() {
    const uint diffuse = indirect ? group_counts[4] : 0u, rays = group_counts[0] + group_counts[1] + diffuse;
    if (rays > 0u) {
        group_first = atomicAdd(queue[params.level + 1u], rays);
        const uint coats = coated ? group_coats : 0u, reflections = group_counts[0] + coats, refractions = group_counts[1] - coats;
        if (reflections > 0u) atomicAdd(queue[QUEUE_REFLECTION], reflections);
        if (refractions > 0u) atomicAdd(queue[QUEUE_REFRACTION], refractions);
        if (diffuse > 0u) atomicAdd(queue[QUEUE_DIFFUSE], diffuse);
        if (group_first + rays > params.next_capacity) atomicOr(queue[QUEUE_OVERFLOW], OVERFLOW_PATHS);
    }
    if (group_cut[0] > 0u) atomicAdd(queue[QUEUE_CUT_REFLECTION], group_cut[0]);
    if (group_cut[1] > 0u) atomicAdd(queue[QUEUE_CUT_REFRACTION], group_cut[1]);
    if (group_counts[2] > 0u) {
        group_first_light = atomicAdd(queue[QUEUE_LIGHT], group_counts[2]);
        if (group_counts[3] > 0u) atomicAdd(queue[QUEUE_AMBIENT], group_counts[3]);
        if (group_first_light + group_counts[2] > params.light_capacity) atomicOr(queue[QUEUE_OVERFLOW], OVERFLOW_LIGHT);
    }
}

/// Workgroups for the next level's rays and for the shadow rays so far. None where something did not fit: everything is
/// done again then, and only the counting of shadow rays goes on.
void countGroups() {
    const uint overflow = atomicOr(queue[QUEUE_OVERFLOW], 0u);
    if (params.level < frame[0].last_level)
        storeRays(params.level + 1u, (overflow & ~OVERFLOW_LIGHT) == 0u ? atomicAdd(queue[params.level + 1u], 0u) : 0u);
    storeRays(QUEUE_GROUPS_LIGHT, overflow == 0u ? atomicAdd(queue[QUEUE_LIGHT], 0u) : 0u);
}

/// What a thread knows of its hit, from shading it until the workgroup has room for its rays.
struct Scattering {
    Surface surface;
    SurfaceId from;
    PathNode node;
    Branch reflection, refraction, diffuse;
    uint reflection_slot, refraction_slot, diffuse_slot, light_slot;  ///< among the rays of the workgroup
    uint light_rays;
    DrawnLight found;
    MediaStack before, behind;  ///< media on either side of the surface
    vec3 lost;         ///< share of the light that gets through the medium to where the hit is seen from
    vec3 path_weight;  ///< of the path up to here
    vec3 light_share;  ///< of a shadow catcher: what is behind it over its light
};

/// The ray that thread `i` follows and what it hit; false: none.
bool startOf(uint i, out Ray ray, out RayState state, out Hit hit) {
    if (camera) {
        const uvec2 pixel = recordPixel(i, params.first_row);
        if (i >= params.capacity || pixel.x >= frame[0].width || pixel.y >= frame[0].height) return false;
        cameraStart(pixel, params.jitter, by_number, ray, state, hit);
        return true;
    }
    if (i >= (params.level > 0u ? min(params.capacity, queue[params.level]) : params.capacity)) return false;
    ray = rays[i];
    state = states[i];
    hit = hits[i];
    return true;
}

/// What surrounds the hit of ray `i` where media may overlap: returns what the surface is to the ray, and adds the media
/// to `c`. `beside`: tint of the walls that coincide with it.
Interface mediaAround(uint i, float t, uint channel, inout Scattering c, out vec3 beside) {
    const MediaWall wall = media_walls[i];
    c.before = wall.before;
    c.behind = wall.behind;
    beside = wall.beside;
    const uint medium = mediaMaterial(c.before);
    c.lost = wall.passed * transmittance(medium, t);
    if (wall.lift > 0.0) c.surface.error = wall.lift;
    const bool is_wall = mediaRank(c.surface.material) != MEDIA_NO_RANK;
    return is_wall ? mediaInterface(wall, channel) : interfaceInAir(materialOf(c.surface), c.surface.front, channel);
}

#include "path/catcher.glsl"

/// Is it what the camera sees of the backdrop through blended surfaces that are not followed any further?
bool passesUntraced(Branch second) { return blended && !second.traced && largest(second.weight) > 0.0 && seesBackdrop(second.medium, params.level + 1u); }

/// Shades what was hit, and counts the rays that it needs for the workgroup.
void shadeHit(uint i, Ray ray, Hit hit, inout RayState state, inout Scattering c) {
    c.node.flags = NODE_SURFACE;
#ifdef SCATTER_DRAWN
    after_scattering = photons != 0u && state.scattered > 0u;
#endif
    const vec2 cone = coneAt(unpackCone(state.cone), hit.t);
    c.surface = surfaceAt(hit.instance, hit.triangle, vec2(hit.u, hit.v), ray.direction, cone.x);
    const uint channel = channelOf(state.medium);
    Interface face = interfaceInAir(materialOf(c.surface), c.surface.front, channel);
    vec3 beside = vec3(1);
    if (layered)
        face = mediaAround(i, hit.t, channel, c, beside);
    else
        c.lost = transmittance(state.medium, hit.t);
    state.weight *= c.lost;
    c.path_weight = state.weight;
    float emission = 1.0;
    if (emitting && materials[c.surface.material].emissive != vec3(0)) emission = emissionShare(c.surface, c.from, ray.direction, hit.t, state);
    c.node.radiance = scatterSurface(c.surface, ray.direction, face, state, cone, emission, c.reflection, c.refraction);
    const bool coat = isCoat(c.refraction);
    if (!coat) c.refraction.weight *= beside;
    const Material m = materialOf(c.surface);
    const bool catches = catching && (m.flags & MATERIAL_CATCHER) != 0u;
    // What is not traced sees the environment.
    if (!catches && !c.reflection.traced) c.node.radiance += untracedLight(c.reflection);
    if (!catches && !c.refraction.traced) c.node.radiance += passesUntraced(c.refraction) ? c.refraction.weight * backdropRadiance(c.refraction.direction) : untracedLight(c.refraction);
    uint sky_rays = 0u;
    if (catches) {
        catchShadows(ray, state, m, c, sky_rays);
    } else if ((m.flags & MATERIAL_UNLIT) != 0u) {
        c.node.flags |= NODE_UNLIT;
    } else if (!ignoresLight(c.surface, m)) {
        const Shade shade = shadeOf(c.surface, m, -ray.direction);
        if (indirect) c.diffuse = diffuseBranch(c.surface, m, shade, -ray.direction, state, cone, mediumBehind(c.surface, m, state.medium));
        c.node.radiance += c.surface.alpha * unshadowedLight(c.surface, m, shade, -ray.direction, c.from, state, env_filtered || !c.diffuse.traced, c.light_rays, sky_rays, c.found);
    }
    c.node.radiance *= c.lost;
    if (catching) c.light_share *= c.lost;
    if (isCut(c.reflection, state, false)) atomicAdd(group_cut[0], 1u);
    if (isCut(c.refraction, state, c.surface.alpha < 1.0)) atomicAdd(group_cut[coat ? 0 : 1], 1u);
    if (c.reflection.traced) c.reflection_slot = atomicAdd(group_counts[0], 1u);
    if (c.refraction.traced) c.refraction_slot = atomicAdd(group_counts[1], dispersive && c.refraction.dispersed ? 3u : 1u);
    if (coat && c.refraction.traced) atomicAdd(group_coats, 1u);
    if (indirect && c.diffuse.traced) c.diffuse_slot = atomicAdd(group_counts[4], 1u);
    if (c.light_rays > 0u) c.light_slot = atomicAdd(group_counts[2], c.light_rays);
    if (sky_rays > 0u) atomicAdd(group_counts[3], sky_rays);
}

/// The rays of red, green and blue, from `first` on.
void emitDispersed(uint first, Scattering c, uint seed, uint scattered) {
    for (uint channel = 1u; channel <= 3u; channel++) {
        Branch one = c.refraction;
        one.direction = channel == 1u ? one.red : (channel == 2u ? one.direction : one.blue);
        one.medium += channel * RAY_CHANNEL_UNIT;
        const vec3 weight = c.path_weight * one.weight * vec3(equal(uvec3(channel), uvec3(1, 2, 3)));
        emitRay(first + channel - 1u, one, c.behind, c.surface, c.from, weight, seed, scattered);
    }
}

/// Puts the next level's rays into the room that reserve() made.
void emitBranches(uint i, Scattering c, RayState state) {
    PathBranches children = PathBranches(c.reflection.weight * c.lost, NO_CHILD, c.refraction.weight * c.lost, NO_CHILD, vec3(0), NO_CHILD);
    if (c.reflection.traced) {
        children.child0 = group_first + c.reflection_slot;
        emitRay(children.child0, c.reflection, c.before, c.surface, c.from, c.path_weight * c.reflection.weight, branchSeed(state.seed, 0u, params.level), state.scattered);
    }
    if (c.refraction.traced) {
        children.child1 = group_first + group_counts[0] + c.refraction_slot;
        const uint seed = branchSeed(state.seed, 1u, params.level);
        if (dispersive && c.refraction.dispersed)
            emitDispersed(children.child1, c, seed, state.scattered);
        else
            emitRay(children.child1, c.refraction, isCoat(c.refraction) ? c.before : c.behind, c.surface, c.from, c.path_weight * c.refraction.weight, seed, state.scattered);
    }
    if (indirect && c.diffuse.traced) {
        children.child2 = group_first + group_counts[0] + group_counts[1] + c.diffuse_slot;
        children.weight2 = c.diffuse.weight * c.lost;
        const bool back = dot(c.surface.normal, c.diffuse.direction) < 0.0 && transmits(materialOf(c.surface));
        emitRay(children.child2, c.diffuse, back ? c.behind : c.before, c.surface, c.from, c.path_weight * c.diffuse.weight, branchSeed(state.seed, 2u, params.level),
                state.scattered + 1u);
    }
    if (frame[0].backdrop == BACKDROP_NONE && passesUntraced(c.refraction)) children.child1 = BACKDROP_CHILD;
    branches[i] = children;
}

void main() {
    const uint i = GLOBAL_INDEX, lane = gl_LocalInvocationIndex;
    if (lane < 5u) group_counts[lane] = 0u;
    if (lane < 2u) group_cut[lane] = 0u;
    if (coated && lane == 0u) group_coats = 0u;
    barrier();
    Ray ray;
    RayState state;
    Hit hit;
    const bool valid = startOf(i, ray, state, hit);
    Scattering c;
    c.node = PathNode(vec3(0), 0u, 0u);
    c.reflection = c.refraction = c.diffuse = NO_BRANCH;
    c.before = c.behind = MEDIA_AIR;
    c.light_rays = 0u;
    c.found = NO_DRAWN_LIGHT;
    if (valid && hit.triangle == NO_TRIANGLE) c.node = missNode(ray.direction, state.medium, params.level, skyAlong(ray, state), layered ? media_walls[i].passed : vec3(1));
    if (valid && hit.triangle != NO_TRIANGLE) {
        c.from = SurfaceId(hit.instance, hit.triangle);
        shadeHit(i, ray, hit, state, c);
    }
    barrier();
    if (lane == 0u) reserve();
    barrier();
    if (valid) {
        if (c.reflection.traced || c.refraction.traced || (indirect && c.diffuse.traced) || (frame[0].backdrop == BACKDROP_NONE && passesUntraced(c.refraction))) {
            c.node.flags |= NODE_BRANCHES;
            if (dispersive && c.refraction.traced && c.refraction.dispersed) c.node.flags |= NODE_DISPERSED;
            emitBranches(i, c, state);
        }
        if (catching && photons != 0u && (c.node.flags & NODE_CATCHER) != 0u) branches[i].weight2 = c.light_share;  // for photon_gather
        if (c.light_rays > 0u) {
            c.node.first_light = group_first_light + c.light_slot;
            c.node.flags |= c.light_rays;
            if (catching && (c.node.flags & NODE_CATCHER) != 0u)
                emitCaught(c.node.first_light, c.node.first_light + c.light_rays, c.surface, -ray.direction, c.light_share, c.before, c.from, state.seed);
            else
                emitLights(c.node.first_light, c.node.first_light + c.light_rays, c.surface, materialOf(c.surface), -ray.direction, c.surface.alpha * c.lost, c.found, env_filtered || !c.diffuse.traced,
                           c.before, c.behind, c.from, state.seed);
        }
        nodes[i] = c.node;
    }
    if (lane == 0u && isLastGroup()) countGroups();
}
