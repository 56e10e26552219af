// Adds to the nodes of a level what the photons around each hit bring: the density of their flux in a disc on the surface. Their light is
// counted in whole units, 64 bits for each channel, so that the sum does not depend on the order in which they are stored.
#version 460
#extension GL_EXT_control_flow_attributes : require
#include "common/common.glsl"
#include "caustics/photon_params.h"
#include "common/ray.h"
#include "path/frame.h"
#include "path/media_params.h"
#include "view/view_params.h"
layout(local_size_x = 64) in;
layout(constant_id = 0) const bool camera = false;     // level 0
layout(constant_id = 1) const bool by_number = false;  // see seen.glsl
layout(constant_id = 2) const bool layered = false;    // media may overlap or touch
PARAMS(PhotonGatherParams)
#define SCENE_FIRST_BINDING 0
#define SCENE_WITH_TRIANGLES
#include "path/scene_buffers.glsl"
BUFFER(readonly, 12, Ray, rays)
BUFFER(readonly, 13, RayState, states)
BUFFER(readonly, 14, Hit, hits)
BUFFER(, 15, PathNode, nodes)
BUFFER(readonly, 16, PathBranches, branches)
BUFFER(readonly, 17, uint, queue)
BUFFER(readonly, 18, uvec2, visibility)
BUFFER(readonly, 19, GpuDraw, draws)
BUFFER(readonly, 20, MediaWall, media_walls)
BUFFER(readonly, 21, uint, media_ranks)
BUFFER(readonly, 22, uvec2, photon_buckets)  // x: the first photon, y: how many
BUFFER(readonly, 23, Photon, sorted_photons)
BUFFER(readonly, 24, GpuLight, lights)
#include "path/frame.glsl"
#include "path/media.glsl"
#include "path/lighting.glsl"
#include "view/camera.glsl"
#include "view/camera_hit.glsl"
#include "view/seen.glsl"
#include "view/camera_start.glsl"
#include "caustics/followed.glsl"
#include "caustics/photon_grid.glsl"

/// A sum in units: low words, high words.
struct Units {
    uvec3 low, high;
};

void add(inout Units sum, vec3 light) {
    const vec3 units = floor(abs(light) * params.inverse_unit + 0.5), over = floor(units * (1.0 / 4294967296.0));
    uvec3 low = uvec3(units - over * 4294967296.0), high = uvec3(over), carry;
    // Two's complement.
    const bvec3 negative = lessThan(light, vec3(0));
    high = mix(high, ~high + uvec3(equal(low, uvec3(0))), negative);
    low = mix(low, ~low + 1u, negative);
    sum.low = uaddCarry(sum.low, low, carry);
    sum.high += high + carry;
}

vec3 lightOf(Units sum) {
    const bvec3 negative = greaterThanEqual(sum.high, uvec3(0x80000000u));
    const uvec3 high = mix(sum.high, ~sum.high + uvec3(equal(sum.low, uvec3(0))), negative), low = mix(sum.low, ~sum.low + 1u, negative);
    const vec3 size = (vec3(high) * 4294967296.0 + vec3(low)) / params.inverse_unit;
    return mix(size, -size, negative);
}

/// What the surface sends towards `view` of each unit of flux that comes from `to_light` to a unit of its area: as of a lamp's light, what
/// is scattered alone.
vec3 scatteredFlux(Surface s, Material m, Shade shade, vec3 view, vec3 to_light) {
    if (lightSeeps(s, shade, to_light)) return shade.seeping * (leftByMirroring(s, m, shade, view) * shade.below_sheen * shade.below_coat);
    const float n_l = dot(s.normal, to_light);
    if (n_l <= 0.0) return vec3(0);
    const vec3 dielectric = interfaceReflectance(m, interfaceInAir(m, s.front, CHANNEL_MIDDLE), clamp(dot(view, normalize(view + to_light)), 0.0, 1.0));
    const float below = sheened ? min(shade.below_sheen, belowSheen(m, n_l)) : 1.0;
    return shade.diffuse * ((1.0 - largest(dielectric)) * below * shade.below_coat);
}

/// Photon `k`, if it is in the cube of the grid and near the surface.
void gatherPhoton(uint k, ivec3 cell, Surface s, Material m, Shade shade, vec3 view, inout Units sum) {
    const Photon photon = sorted_photons[k];
    const vec3 way = photon.position - s.position;
    const float distance2 = dot(way, way), radius2 = params.radius * params.radius;
    if (distance2 >= radius2 || abs(dot(way, s.geometric)) > PHOTON_FLATNESS * params.radius) return;
    // Other cubes may share the bucket.
    if (photonCell(photon.position, params.lower, params.inverse_cell) != cell) return;
    const vec3 to_light = -photon.direction;
    const float side = dot(photon.normal, s.geometric);
    if ((lightSeeps(s, shade, to_light) ? -side : side) < PHOTON_SAME_SIDE) return;
    // Epanechnikov's kernel.
    const float density = (1.0 - distance2 / radius2) * 2.0 / (PI * radius2);
    add(sum, photon.flux * density * scatteredFlux(s, m, shade, view, to_light));
}

/// Four at a time: a software device may bound the loop iterations of an invocation (docs/lab_notes.md).
void gatherCell(ivec3 cell, Surface s, Material m, Shade shade, vec3 view, inout Units sum) {
    const uvec2 bucket = photon_buckets[photonBucket(cell, params.mask)];
    const uint end = bucket.x + bucket.y;
    [[dont_unroll]] for (uint k = bucket.x; k < end; k += 4u) {
        gatherPhoton(k, cell, s, m, shade, view, sum);
        if (k + 1u < end) gatherPhoton(k + 1u, cell, s, m, shade, view, sum);
        if (k + 2u < end) gatherPhoton(k + 2u, cell, s, m, shade, view, sum);
        if (k + 3u < end) gatherPhoton(k + 3u, cell, s, m, shade, view, sum);
    }
}

vec3 gathered(Surface s, Material m, vec3 view) {
    const Shade shade = shadeOf(s, m, view);
    const ivec3 first = photonCell(s.position - params.radius, params.lower, params.inverse_cell),
                last = photonCell(s.position + params.radius, params.lower, params.inverse_cell);
    Units sum = Units(uvec3(0), uvec3(0));
    [[dont_unroll]] for (int z = first.z; z <= last.z; z++)
        [[dont_unroll]] for (int y = first.y; y <= last.y; y++)
            [[dont_unroll]] for (int x = first.x; x <= last.x; x++) gatherCell(ivec3(x, y, z), s, m, shade, view, sum);
    return lightOf(sum);
}

/// The ray that thread `i` follows and what it hit; false: nothing.
bool startOf(uint i, out Ray ray, out RayState state, out Hit hit) {
    if (camera) {
        const uvec2 pixel = recordPixel(i, params.level.first_row);
        if (i >= params.level.capacity || pixel.x >= frame[0].width || pixel.y >= frame[0].height) return false;
        cameraStart(pixel, params.level.jitter, by_number, ray, state, hit);
    } else {
        if (i >= (params.level.level > 0u ? min(params.level.capacity, queue[params.level.level]) : params.level.capacity)) return false;
        ray = rays[i];
        state = states[i];
        hit = hits[i];
    }
    return hit.triangle != NO_TRIANGLE;
}

void main() {
    const uint i = GLOBAL_INDEX;
    Ray ray;
    RayState state;
    Hit hit;
    if ((queue[QUEUE_OVERFLOW] & ~OVERFLOW_LIGHT) != 0u || !startOf(i, ray, state, hit)) return;
    Surface s = surfaceAt(hit.instance, hit.triangle, vec2(hit.u, hit.v), ray.direction, coneAt(unpackCone(state.cone), hit.t).x);
    const Material m = materialOf(s);
    if (photonsStay(m) == 0.0) return;
    vec3 lost = layered ? media_walls[i].passed * transmittance(mediaMaterial(media_walls[i].before), hit.t) : transmittance(state.medium, hit.t);
    // A catcher's node holds what is behind it over all of its light.
    if (catching && (m.flags & MATERIAL_CATCHER) != 0u) lost = branches[i].weight2;
    nodes[i].radiance += gathered(s, m, -ray.direction) * lost * s.alpha;
}
