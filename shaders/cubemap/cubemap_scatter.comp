// The baseline's scatter: what a hit reflects and lets through is looked up, by direction alone, in the cube map of the hit's
// object. No ray is traced.
#version 460
#include "common/common.glsl"
#include "common/ray.h"
#include "cubemap/cubemap_params.h"
#include "path/path_params.h"
layout(local_size_x = 64) in;
PARAMS(LevelParams)
#define SCENE_FIRST_BINDING 0
#define SCENE_WITH_TRIANGLES
#include "path/scene_buffers.glsl"
BUFFER(readonly, 12, Ray, rays)
BUFFER(readonly, 13, RayState, states)
BUFFER(readonly, 14, Hit, hits)
BUFFER(writeonly, 15, PathNode, nodes)
BUFFER(readonly, 16, uint, triangle_objects)
BUFFER(readonly, 17, GpuObject, objects)
BUFFER(readonly, 18, uvec2, probes)
#define CUBE_TEXEL(index) unpackTexel(probes[index])
#include "cubemap/cubemap.glsl"
#include "path/frame.glsl"
#include "path/branches.glsl"
#include "path/backdrop.glsl"

GpuObject object;  // of this thread's hit

/// A cube map holds the whole lobe, blurred: one lookup along the mirror direction.
bool samplesMicrofacets() { return false; }
vec3 microfacet(Lobe lobe, vec3 view, uint seed, uint purpose) { return meanMicrofacet(lobe, view); }
float tracedPart(float roughness, float metallic) { return 1.0; }
bool blursCones() { return false; }
vec3 environmentSeen(vec3 direction, float blur, float density, uint cone, uint medium) { return environmentRadiance(direction, blur); }
void decide(inout Branch branch, RayState state, bool passes) {
    branch.traced = (frame[0].effects & branch.effect) != 0u && object.probe != NO_PROBE;
}

/// Light from a direction: the probe's, and where it holds nothing the environment's.
vec3 seenAlong(vec3 direction, bool sees_sun, float roughness) {
    const bool mirror = roughness < MIRROR_ROUGHNESS;
    const vec4 near = cubeRoughLookup(object.probe, object.face, object.levels, direction, mirror ? 0.0 : roughness);
    vec3 far;
    if (mirror) {
        far = skyRadiance(direction, sees_sun);
    } else {
        far = environmentRadiance(direction, roughness);
        far *= min(1.0, frame[0].rough_limit / max(largest(far), 1e-30));
    }
    return near.rgb + (1.0 - near.a) * far;
}

/// What the camera sees straight through a blended surface; `through`: share of the backdrop's light in it, where the picture is transparent.
vec3 seenThrough(Branch branch, out float through) {
    const vec4 near = branch.traced ? cubeRoughLookup(object.probe, object.face, object.levels, branch.direction, 0.0) : vec4(0);
    through = frame[0].backdrop == BACKDROP_NONE ? luminance(branch.weight) * (1.0 - near.a) : 0.0;
    return branch.weight * (near.rgb + (1.0 - near.a) * backdropRadiance(branch.direction));
}

vec3 seen(Branch branch, float roughness) {
    if (!branch.traced) return untracedLight(branch);
    const bool sees_sun = (branch.medium & RAY_SEES_SUN) != 0u;
    vec3 light = seenAlong(branch.direction, sees_sun, roughness);
    if (dispersive && branch.dispersed) {
        light.r = seenAlong(branch.red, sees_sun, roughness).r;
        light.b = seenAlong(branch.blue, sees_sun, roughness).b;
    }
    return branch.weight * light;
}

void main() {
    const uint i = GLOBAL_INDEX;
    if (i >= params.capacity) return;
    const Ray ray = rays[i];
    const RayState state = states[i];
    const Hit hit = hits[i];
    PathNode node = missNode(ray.direction, state.medium, 0u, skyRadiance(ray.direction, (state.medium & RAY_SEES_SUN) != 0u), vec3(1));
    if (hit.triangle != NO_TRIANGLE) {
        object = objects[instances[hit.instance].info.first_object + triangle_objects[hit.triangle]];
        const vec2 cone = coneAt(unpackCone(state.cone), hit.t);
        const Surface s = surfaceAt(hit.instance, hit.triangle, vec2(hit.u, hit.v), ray.direction, cone.x);
        const Material m = materialOf(s);
        node.flags = NODE_SURFACE | ((m.flags & MATERIAL_UNLIT) != 0u ? NODE_UNLIT : 0u);
        Branch reflection, refraction;
        node.radiance = scatterSurface(s, ray.direction, interfaceInAir(m, s.front, 0u), state, cone, 1.0, reflection, refraction);
        node.radiance += seen(reflection, reflection.blur);
        // One interface, as rasterisers do: bent where the light enters, dimmed by the thickness that the material
        // states, and blurred less the less it bends (the glTF Sample Viewer's rule).
        const bool coat = isCoat(refraction);
        const float bent = blended && s.alpha < 1.0 ? 0.0 : m.roughness * clamp(2.0 * m.ior - 2.0, 0.0, 1.0);
        if (refraction.traced && !coat && (m.flags & MATERIAL_THIN) == 0u && s.front) refraction.weight *= exp(-m.absorption * min(m.thickness, object.thickness));
        float through = 0.0;
        node.radiance += seesBackdrop(refraction.medium, 1u) ? seenThrough(refraction, through) : seen(refraction, coat ? m.coat_roughness : bent);
        node.first_light = floatBitsToUint(through);
        if (through > 0.0) node.flags |= NODE_BACKDROP;
    }
    nodes[i] = node;
}
