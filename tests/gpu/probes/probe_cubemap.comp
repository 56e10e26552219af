// A cube map whose texels hold their own directions.
#version 460
#include "common/common.glsl"
vec4 ownDirection(uint index);
#define CUBE_TEXEL(index) ownDirection(index)
#include "cubemap/cubemap.glsl"
#include "probe.glsl"
struct Input { vec3 direction; uint size; };
struct Output { vec3 looked_up; uint face; vec3 from_face; };
PROBE(Input, Output)

uint map_size;
vec4 ownDirection(uint index) {
    const uint texels = map_size * map_size;
    return vec4(normalize(cubeTexelDirection(index / texels, uvec2(index % map_size, index % texels / map_size), map_size)), 1);
}

Output probe(Input x) {
    map_size = x.size;
    vec2 p;
    const uint face = cubeFace(x.direction, p);
    return Output(cubeLookup(0u, x.size, x.direction).xyz, face, cubeDirection(face, p));
}
