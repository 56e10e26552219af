// What becomes of each photon where it has come to a surface: it stays there, is reflected, goes through, or is lost. Each keeps its place
// in the buffers, so that nothing depends on the order of threads.
#version 460
#extension GL_EXT_control_flow_attributes : require
#include "common/common.glsl"
#include "caustics/photon_params.h"
#include "common/ray.h"
#include "path/frame.h"
#include "path/media_params.h"
layout(local_size_x = 64) in;
layout(constant_id = 0) const bool layered = false;  // media may overlap or touch: photons were traced by trace_media
PARAMS(PhotonScatterParams)
#define SCENE_FIRST_BINDING 0
#define SCENE_WITH_TRIANGLES
#include "path/scene_buffers.glsl"
BUFFER(, 12, Ray, rays)
BUFFER(writeonly, 13, SurfaceId, skip)
BUFFER(readonly, 14, Hit, hits)
BUFFER(, 15, PhotonState, photon_states)
BUFFER(writeonly, 16, Photon, photons)
BUFFER(readonly, 17, GpuLight, lights)
BUFFER(readonly, 18, MediaWall, media_walls)
BUFFER(readonly, 19, uint, media_ranks)
BUFFER(writeonly, 20, MediaStack, media)
BUFFER(, 21, uint, queue)
#include "path/frame.glsl"
#include "path/media.glsl"
#include "path/branches.glsl"
#include "path/random.glsl"
#include "caustics/followed.glsl"

uint photon = 0u;  // of this thread

vec2 randomAt(uint purpose) { return randomPair(params.seed, params.level, photon, params.bits, purpose, params.picture); }

// Photons are samples, whatever the picture's pixels are.
bool samplesMicrofacets() { return true; }
vec3 microfacet(Lobe lobe, vec3 view, uint seed, uint purpose) {
    return isSampled(lobe) ? sampleMicrofacet(lobe, view, randomAt(purpose)) : meanMicrofacet(lobe, view);
}
float tracedPart(float roughness, float metallic) { return photonsFollow(roughness, metallic) ? 1.0 : 0.0; }
vec3 environmentSeen(vec3 direction, float blur, float density, uint cone, uint medium) { return vec3(0); }
bool blursCones() { return false; }

/// Where shadow rays go straight through everything, so does all light that passes glass: no photon may bring it again.
void decide(inout Branch branch, RayState state, bool passes) {
    const uint needed = branch.effect == EFFECT_REFRACTION ? EFFECT_REFRACTION | EFFECT_SHADOW : branch.effect;
    if ((frame[0].effects & needed) != needed) branch.weight = vec3(0);
}

void lose() {
    rays[photon].direction = vec3(0);  // which hits nothing
    photon_states[photon].flux = vec3(0);
}

/// What surrounds a hit.
struct Around {
    Surface surface;
    Interface face;
    MediaStack before, behind;
    vec3 lost;    ///< share of the light that gets through the medium up to here
    vec3 beside;  ///< tint of walls that coincide with this one
};

Around aroundHit(Ray ray, Hit hit, uint medium) {
    Around a;
    a.surface = surfaceAt(hit.instance, hit.triangle, vec2(hit.u, hit.v), ray.direction, 0.0);
    const uint channel = channelOf(medium);
    a.face = interfaceInAir(materialOf(a.surface), a.surface.front, channel);
    a.before = a.behind = MEDIA_AIR;
    a.beside = vec3(1);
    if (!layered) {
        a.lost = transmittance(medium, hit.t);
        return a;
    }
    const MediaWall wall = media_walls[photon];
    a.before = wall.before;
    a.behind = wall.behind;
    a.beside = wall.beside;
    a.lost = wall.passed * transmittance(mediaMaterial(wall.before), hit.t);
    if (wall.lift > 0.0) a.surface.error = wall.lift;
    if (mediaRank(a.surface.material) != MEDIA_NO_RANK) a.face = mediaInterface(wall, channel);
    return a;
}

/// Goes on along a branch, `weight` times as bright.
void follow(Around a, SurfaceId from, PhotonState state, Branch branch, MediaStack stack, vec3 weight) {
    state.flux *= weight;
    state.medium = branch.medium;
    if (state.flux == vec3(0)) {
        lose();
        return;
    }
    rays[photon] = leavingRay(a.surface, a.surface.position, branch.direction, uintBitsToFloat(0x7f800000u));
    skip[photon] = from;
    photon_states[photon] = state;
    if (layered) media[photon] = stack;
}

/// Where the lamp's light has not come to its end before (KHR_lights_punctual's range).
float withinRange(PhotonState state) {
    if (lights[state.light].kind == 0u) return 1.0;
    const float r = state.way / lights[state.light].range, r2 = r * r;
    return clamp(1.0 - r2 * r2, 0.0, 1.0);
}

void settle(Around a, Ray ray, PhotonState state, float probability) {
    photons[photon] = Photon(a.surface.position, a.surface.geometric, ray.direction, state.flux * (withinRange(state) / probability));
    atomicAdd(queue[QUEUE_PHOTONS], 1u);
    lose();
}

/// Red, green and blue go their own ways: one of them is followed.
void chooseColor(float random, inout Branch branch) {
    const uint channel = min(uint(random * 3.0), 2u);
    if (channel != 1u) branch.direction = channel == 0u ? branch.red : branch.blue;
    branch.medium += (channel + 1u) * RAY_CHANNEL_UNIT;
    branch.weight *= 3.0 * vec3(equal(uvec3(channel), uvec3(0, 1, 2)));
}

/// Probabilities of what may become of a photon; what is left of 1 is that of its loss. What goes on is to have a photon's usual light, so
/// that none is much brighter than others.
struct Fates {
    float settles, passes, reflects, refracts;
};

/// `coverage`: of the surface that is there in part; `state.specular`: how far the photon has come.
Fates fatesOf(Material m, PhotonState state, float coverage, bool ends, vec3 reflected, vec3 through) {
    const vec3 light = abs(state.flux) / params.usual;
    Fates f = Fates(state.specular > 0u ? coverage * photonsStay(m) * largest(light) : 0.0, ends ? 0.0 : (1.0 - coverage) * largest(light), 0.0, 0.0);
    if (!ends && state.specular < frame[0].bounces) {
        f.reflects = coverage * largest(light * reflected);
        f.refracts = coverage * largest(light * through);
    }
    const float others = f.passes + f.reflects + f.refracts;
    if (f.settles > 0.0) f.settles = others == 0.0 ? 1.0 : max(f.settles / (f.settles + others), PHOTON_LEAST_END);
    const float rest = (1.0 - f.settles) / max(others, 1.0);
    f.passes *= rest;
    f.reflects *= rest;
    f.refracts *= rest;
    return f;
}

void meetSurface(Ray ray, Hit hit, PhotonState state) {
    Around a = aroundHit(ray, hit, state.medium);
    const SurfaceId from = SurfaceId(hit.instance, hit.triangle);
    const Material m = materialOf(a.surface);
    state.flux *= a.lost;
    state.way += hit.t;
    const float coverage = a.surface.alpha;
    a.surface.alpha = 1.0;
    Branch reflection, refraction;
    scatterSurface(a.surface, ray.direction, a.face, RayState(vec3(1), state.medium, 0u, 0u, 0.0, 0u), vec2(0), 0.0, reflection, refraction);
    const bool coat = isCoat(refraction), catcher = catching && (m.flags & MATERIAL_CATCHER) != 0u;
    if (!coat) refraction.weight *= a.beside;
    const Fates f = fatesOf(m, state, coverage, params.last != 0u || catcher, reflection.weight, refraction.weight);
    vec2 random = randomAt(RANDOM_PHOTON_WAY);
    if (random.x < f.settles) {
        settle(a, ray, state, f.settles);
    } else if (random.x < f.settles + f.passes) {
        const uint passed = (state.medium & RAY_PASSES) == RAY_PASSES ? state.medium : state.medium + RAY_PASSED;
        follow(a, from, state, branchAlong(vec3(1), ray.direction, passed, 0u, 0u, 0.0), a.behind, vec3((1.0 - coverage) / f.passes));
    } else if (random.x < f.settles + f.passes + f.reflects) {
        state.specular++;
        follow(a, from, state, reflection, a.before, reflection.weight * (coverage / f.reflects));
    } else if (random.x < f.settles + f.passes + f.reflects + f.refracts) {
        state.specular++;
        if (dispersive && refraction.dispersed && !coat) chooseColor(random.y, refraction);
        follow(a, from, state, refraction, coat ? a.before : a.behind, refraction.weight * (coverage / f.refracts));
    } else {
        lose();
    }
}

void main() {
    photon = GLOBAL_INDEX;
    if (photon >= params.count) return;
    const PhotonState state = photon_states[photon];
    if (state.flux == vec3(0)) return;
    const Hit hit = hits[photon];
    if (hit.triangle == NO_TRIANGLE)
        lose();
    else
        meetSurface(rays[photon], hit, state);
}
