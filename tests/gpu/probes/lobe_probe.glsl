// lobe.glsl with as much of a surface and its material as it needs.
#include "path/shading.glsl"
struct Surface { vec3 normal, along; float stretch; };
struct Material { float roughness; };
const bool stretched = true;
vec3 directionOr(vec3 v, vec3 otherwise) { return dot(v, v) > 0.0 ? normalize(v) : otherwise; }
#include "path/lobe.glsl"
struct Input { Surface surface; float roughness; vec3 view; float index; vec2 random; };
