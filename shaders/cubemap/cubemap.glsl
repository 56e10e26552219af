// Cube maps in a buffer, without bindings. For lookups define CUBE_TEXEL(index) before including: the vec4 of a texel.
//
// Face 2 a + s shows what lies towards axis a (0 to 2: x, y, z), s = 1: towards its negative end. On the face, x runs along the
// axis after a and -y along the one after that (x, y, z, x, y), for both signs alike. A face's outermost texel centres lie on
// the cube's edges: two faces sample the same directions there, so that bilinear lookups have no seam.
#ifndef PEELRAY_CUBEMAP_GLSL
#define PEELRAY_CUBEMAP_GLSL

#include "cubemap/cubemap_params.h"

/// The direction to a place on a face, both coordinates in [-1, 1]; its largest component is ±1.
vec3 cubeDirection(uint face, vec2 p) {
    const float side = (face & 1u) != 0u ? -1.0 : 1.0;
    const uint axis = face >> 1u;
    return axis == 0u ? vec3(side, p.x, p.y) : (axis == 1u ? vec3(p.y, side, p.x) : vec3(p.x, p.y, side));
}

/// The face that a direction meets, and where.
uint cubeFace(vec3 d, out vec2 p) {
    const vec3 a = abs(d);
    const uint axis = a.x >= a.y && a.x >= a.z ? 0u : (a.y >= a.z ? 1u : 2u);
    const vec3 turned = axis == 0u ? d.xyz : (axis == 1u ? d.yzx : d.zxy);
    p = turned.yz / max(abs(turned.x), 1e-30);
    return 2u * axis + (turned.x < 0.0 ? 1u : 0u);
}

/// The direction to a texel's centre.
vec3 cubeTexelDirection(uint face, uvec2 texel, uint size) {
    const vec2 p = vec2(texel) * (2.0 / float(size - 1u)) - 1.0;
    return cubeDirection(face, vec2(p.x, -p.y));
}

/// Radiance times coverage, and coverage, in half floats.
uvec2 packTexel(vec4 t) { return uvec2(packHalf2x16(min(t.rg, vec2(65504.0))), packHalf2x16(vec2(min(t.b, 65504.0), t.a))); }
vec4 unpackTexel(uvec2 t) { return vec4(unpackHalf2x16(t.x), unpackHalf2x16(t.y)); }

#ifdef CUBE_TEXEL
/// Bilinear lookup in the map of six size·size faces from texel `first` on.
vec4 cubeLookup(uint first, uint size, vec3 d) {
    vec2 p;
    const uint face = cubeFace(d, p);
    const vec2 at = (vec2(p.x, -p.y) * 0.5 + 0.5) * float(size - 1u);
    const uvec2 i = uvec2(clamp(at, vec2(0), vec2(size - 2u)));
    const vec2 f = at - vec2(i);
    const uint above = first + (face * size + i.y) * size + i.x, below = above + size;
    return mix(mix(CUBE_TEXEL(above), CUBE_TEXEL(above + 1u), f.x), mix(CUBE_TEXEL(below), CUBE_TEXEL(below + 1u), f.x), f.y);
}

uint cubeLevelSize(uint face, uint level) { return max(face >> level, PROBE_SMALLEST_FACE); }

/// Texels of all levels before this one.
uint cubeLevelOffset(uint face, uint level) {
    uint offset = 0u;
    for (uint i = 0u; i < level; i++) {
        const uint size = cubeLevelSize(face, i);
        offset += 6u * size * size;
    }
    return offset;
}

/// The map of `levels` levels blurred to a roughness.
vec4 cubeRoughLookup(uint first, uint face, uint levels, vec3 d, float roughness) {
    const float level = sqrt(clamp(roughness, 0.0, 1.0)) * float(levels - 1u);
    const uint lower = uint(level), upper = min(lower + 1u, levels - 1u);
    const vec4 sharp = cubeLookup(first + cubeLevelOffset(face, lower), cubeLevelSize(face, lower), d);
    const float part = level - float(lower);
    return part > 0.0 ? mix(sharp, cubeLookup(first + cubeLevelOffset(face, upper), cubeLevelSize(face, upper), d), part) : sharp;
}

#endif
#endif
