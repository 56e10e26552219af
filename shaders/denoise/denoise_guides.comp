// What the denoiser is guided by, added up sample by sample: along each camera ray the first surface that sends light drawn at random.
// One pass a level: rays that meet a mirror there, or clear glass, go on to the next along the brighter branch.
#version 460
#include "common/common.glsl"
#include "common/ray.h"
#include "denoise/denoise_params.h"
#include "path/frame.h"
#include "path/path_params.h"
#include "view/view_params.h"
layout(local_size_x = 64) in;
layout(constant_id = 0) const bool camera = false;     // level 0
layout(constant_id = 1) const bool by_number = false;  // see seen.glsl
layout(constant_id = 2) const bool kept = false;       // this level's rays and hits are in buffers
PARAMS(DenoiseGuideParams)
#define SCENE_FIRST_BINDING 0
#define SCENE_WITH_TRIANGLES
#include "path/scene_buffers.glsl"
BUFFER(readonly, 12, Ray, rays)
BUFFER(readonly, 13, RayState, states)
BUFFER(readonly, 14, Hit, hits)
BUFFER(readonly, 15, PathNode, nodes)
BUFFER(readonly, 16, PathBranches, branches)
BUFFER(readonly, 17, PathNode, next_nodes)
BUFFER(readonly, 18, vec3, shadow_light)
BUFFER(readonly, 19, uint, queue)
BUFFER(readonly, 20, uvec2, visibility)
BUFFER(readonly, 21, GpuDraw, draws)
BUFFER(, 22, DenoiseLink, denoise_links)
BUFFER(, 23, DenoiseGuide, denoise_guides)
#include "path/frame.glsl"
#include "path/cone.glsl"
#include "path/interface.glsl"
#include "path/lobe.glsl"
#include "path/ignores_light.glsl"
#include "path/gather.glsl"
#include "view/camera.glsl"
#include "view/camera_hit.glsl"
#include "view/seen.glsl"
#include "view/camera_start.glsl"
#include "denoise/features.glsl"

const DenoiseLink kNoLink = DenoiseLink(vec3(0), 0.0, NO_CHILD);

/// What a surface is known by to the filter.
struct Look {
    vec3 albedo;  ///< at normal incidence; what is left to angles is not textured
    float gloss;
};

Look lookOf(Surface s, Material m, Lobe lobe, bool mirrors) {
    const float scatters = (1.0 - m.metallic) * (1.0 - m.transmission);
    vec3 diffuse = scatters * s.base_color + m.sheen_color;
    if (seeping) diffuse = mix(diffuse, scatters * m.seeping_color, m.seeping_share);
    vec3 mirrored = mix(normalReflectance(m), s.base_color, m.metallic);
    if (transmits(m)) mirrored += transmissionTint(m, s.base_color);
    const vec3 albedo = max(diffuse + mirrored + (coated ? m.clearcoat * COAT_REFLECTANCE : 0.0), vec3(DENOISE_LEAST_ALBEDO));
    return Look(albedo, mirrors ? clamp(luminance(mirrored) / luminance(albedo), 0.0, 1.0) * (1.0 - lobe.roughness) : 0.0);
}

/// What comes along a node's second branch.
vec3 secondRadiance(uint place, PathNode node) {
    if ((node.flags & NODE_BRANCHES) == 0u) return vec3(0);
    const PathBranches children = branches[place];
    return children.child1 < params.next_capacity ? children.weight1 * litRadiance(next_nodes[children.child1]) : vec3(0);
}

/// What diffuse bounces bring.
vec3 diffuseRadiance(uint place, PathNode node) {
    if ((node.flags & NODE_BRANCHES) == 0u) return vec3(0);
    const PathBranches children = branches[place];
    return children.child2 < params.next_capacity ? children.weight2 * litRadiance(next_nodes[children.child2]) : vec3(0);
}

/// Of a node's light what is drawn at random; `mirrors`: what its lobe mirrors is.
vec3 randomLight(uint place, PathNode node, Surface s, Material m, bool mirrors) {
    if (!mirrors) return litRadiance(node) - node.radiance + diffuseRadiance(place, node);
    vec3 all = litRadiance(node);
    if (camera) all += childrenRadiance(place, node);  // of deeper levels they have been gathered
    const bool beside = s.alpha < 1.0, in_coat = coated && m.clearcoat > 0.0 && m.coat_roughness < MIRROR_ROUGHNESS && !transmits(m);
    if (beside || in_coat) all -= secondRadiance(place, node);
    return max(all - s.alpha * m.emissive, vec3(0));
}

/// Is there light at the surface that is drawn at random? It may be so where this draw is zero: else a pixel would be guided by its draw,
/// now by the surface and now by what that mirrors.
bool isLit(PathNode node, Surface s, Material m) {
    if ((node.flags & NODE_LIGHTS) != 0u) return true;
    return params.finds_light != 0u && !ignoresLight(s, m) && (m.flags & MATERIAL_CATCHER) == 0u;
}

/// On along the branch that shows more.
DenoiseLink followed(uint place, PathNode node, DenoiseLink link, float t) {
    if ((node.flags & NODE_BRANCHES) == 0u) return kNoLink;
    const PathBranches children = branches[place];
    const float first = children.child0 < params.next_capacity ? luminance(children.weight0) : 0.0;
    const bool whole = children.child1 < params.next_capacity && (node.flags & NODE_DISPERSED) == 0u;
    const float second = whole ? luminance(children.weight1) : 0.0;
    if (max(first, second) == 0.0) return kNoLink;
    if (first >= second) return DenoiseLink(link.weight * children.weight0, link.depth + t, children.child0);
    return DenoiseLink(link.weight * children.weight1, link.depth + t, children.child1);
}

void add(uint at, vec3 light, vec3 albedo, vec3 normal, float depth, float gloss) {
    DenoiseGuide sums = denoise_guides[at];
    sums.light += light;
    sums.albedo += albedo;
    sums.surfaces += 1.0;
    sums.depth += depth;
    sums.normal += normal;
    sums.gloss += gloss;
    const float sent = luminance(light) / max(luminance(albedo), 1e-20), before = sent - sums.mean;
    sums.mean += before / sums.surfaces;
    sums.deviations += before * (sent - sums.mean);
    denoise_guides[at] = sums;
}

/// The ray that has come as far as `link` says, and what it hit.
bool startOf(uvec2 pixel, DenoiseLink link, out Ray ray, out vec2 cone, out Hit hit) {
    if (kept) {
        if (link.place >= params.level_capacity) return false;
        ray = rays[link.place];
        cone = unpackCone(states[link.place].cone);
        hit = hits[link.place];
        return hit.triangle != NO_TRIANGLE;
    }
    RayState state;
    cameraStart(pixel, params.jitter, by_number, ray, state, hit);
    cone = frame[0].cone;
    return hit.triangle != NO_TRIANGLE;
}

/// Looks at what was hit; where nothing there is random the result says where to look next.
DenoiseLink lookAt(uint at, DenoiseLink link, Ray ray, vec2 cone, Hit hit) {
    const Surface s = surfaceAt(hit.instance, hit.triangle, vec2(hit.u, hit.v), ray.direction, coneAt(cone, hit.t).x);
    const Material m = materialOf(s);
    if ((m.flags & MATERIAL_UNLIT) != 0u) return kNoLink;
    const PathNode node = nodes[link.place];
    const Lobe lobe = lobeOf(s, m, -ray.direction);
    const bool coat = coated && m.clearcoat > 0.0 && m.coat_roughness >= MIRROR_ROUGHNESS;
    const bool mirrors = params.samples_lobes != 0u && (!isMirror(lobe) || coat);
    if (!mirrors && !isLit(node, s, m)) return followed(link.place, node, link, hit.t);
    vec3 light = link.weight * randomLight(link.place, node, s, m, mirrors);
    const bool finite = all(lessThan(light, vec3(1e30))) && all(greaterThanEqual(light, vec3(0)));
    if (!finite) return kNoLink;
    light *= min(1.0, params.limit / max(largest(light), 1e-30));
    const Look look = lookOf(s, m, lobe, mirrors);
    add(at, light, s.alpha * link.weight * look.albedo, s.normal, link.depth + hit.t, look.gloss);
    return kNoLink;
}

void main() {
    const uint i = GLOBAL_INDEX;
    if (i >= params.capacity || queue[QUEUE_OVERFLOW] != 0u) return;
    const uvec2 pixel = recordPixel(i, params.first_row);
    if (pixel.x >= frame[0].width || pixel.y >= frame[0].height) return;
    const uint at = pixel.y * frame[0].width + pixel.x;
    DenoiseLink link = DenoiseLink(vec3(1), 0.0, i);
    if (!camera) link = denoise_links[i];
    if (link.place == NO_CHILD) return;
    if (camera && params.sample_index == 0u) denoise_guides[at] = DenoiseGuide(vec3(0), 0.0, vec3(0), 0.0, vec3(0), 0.0, 0.0, 0.0);
    Ray ray;
    vec2 cone;
    Hit hit;
    denoise_links[i] = startOf(pixel, link, ray, cone, hit) ? lookAt(at, link, ray, cone, hit) : kNoLink;
}
