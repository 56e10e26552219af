// Access to the scene during a frame: materials, textures, environment, and the surface at a hit.
// Include after scene_buffers.glsl. Directions point away from the surface.
#ifndef PEELRAY_FRAME_GLSL
#define PEELRAY_FRAME_GLSL

#include "common/instance.h"
#include "common/material.h"
#include "common/ray.h"
#include "path/path_params.h"
#include "path/tables.h"

#include "common/placed.glsl"
#include "path/shading.glsl"
#include "common/material.glsl"

/// What shading needs to know of a hit.
struct Surface {
    vec3 position;
    vec3 geometric;    ///< unit normal of the triangle, on the ray's side
    vec3 normal;       ///< interpolated and bent by the normal texture, unit, on the ray's side
    vec3 coat_normal;  ///< of a clear coat
    vec3 shadow_start; ///< position moved to the smooth surface (see shadowStart)
    vec3 base_color;
    float alpha;       ///< share of the surface that is there; the rest of the light goes straight on
    float error;       ///< bound on the position's rounding error, world units
    float offset;      ///< height above it from which secondary rays count, world units (planar hits)
    bool front;        ///< the ray comes from the side that the normals point to
    uint material;
    float curvature;   ///< how much the normal turns per world unit; > 0: the ray meets a bulge. For cones: else 0
    vec3 along;        ///< unit tangent along which a lobe is stretched
    float stretch;     ///< how much, [0, 1]
    TextureFactors factors;
};

/// The surface's material, with its textures.
Material materialOf(Surface s) { return evaluate(s.material, s.factors); }

/// How far the position is lifted to the plane through a corner along the corner's normal; `p`: from the corner.
vec3 lifted(vec3 p, vec3 normal, vec3 geometric) {
    return dot(normal, geometric) > STRAY_NORMAL ? -min(0.0, dot(p, normal)) * normal : vec3(0);
}

/// Where a shadow ray starts on a coarse smooth mesh: on the surface that the interpolated normals describe, so that its facets
/// do not shadow each other (Hanika: Hacking the Shadow Terminator, Ray Tracing Gems II, ch. 4).
vec3 shadowStart(vec3 p, vec3 a, vec3 b, vec3 c, vec3 na, vec3 nb, vec3 nc, vec3 geometric, vec3 weights) {
    return p + lifted(p - a, na, geometric) * weights.x + lifted(p - b, nb, geometric) * weights.y +
           lifted(p - c, nc, geometric) * weights.z;
}

/// A normal as its instance turns it, unit: cofactors are the inverse transpose times the determinant.
vec3 placedNormal(mat3 cofactors, vec3 n) {
    const vec3 turned = cofactors * n;
    return dot(turned, turned) > 0.0 ? normalize(turned) : n;
}

vec3 directionOr(vec3 v, vec3 otherwise) { return dot(v, v) > 0.0 ? normalize(v) : otherwise; }

/// The interpolated tangent and bitangent; false: there are none. As MikkTSpace has it, nothing is made unit.
bool tangentSpace(uint material, TexturePlace place, mat3 linear, float turned, vec3 normal, out vec3 tangent, out vec3 bitangent) {
    const vec4 ta = tangentOf(material, place.corners.x), tb = tangentOf(material, place.corners.y), tc = tangentOf(material, place.corners.z);
    const vec3 weights = place.weights;
    vec3 a = ta.xyz, b = tb.xyz, c = tc.xyz;
    if (linear != mat3(1)) {
        a = directionOr(linear * a, vec3(0));
        b = directionOr(linear * b, vec3(0));
        c = directionOr(linear * c, vec3(0));
    }
    tangent = a * weights.x + b * weights.y + c * weights.z;
    const float side = (ta.w * weights.x + tb.w * weights.y + tc.w * weights.z) * turned;
    bitangent = (side < 0.0 ? -1.0 : 1.0) * cross(normal, tangent);
    return side != 0.0 && dot(tangent, tangent) > 0.0;
}

/// The normal that the material's texture makes of the interpolated one, unit; `otherwise` where there is no texture, or no tangents.
vec3 bentNormal(uint material, int use, TexturePlace place, mat3 linear, float turned, vec3 normal, vec3 otherwise) {
    if (!bendsNormals(material, use)) return otherwise;
    vec3 tangent, bitangent;
    if (!tangentSpace(material, place, linear, turned, normal, tangent, bitangent)) return otherwise;
    const vec3 parts = normalParts(material, use, place);
    return directionOr(tangent * parts.x + bitangent * parts.y + normal * parts.z, otherwise);
}

/// How the material stretches the lobe around the surface's shading normal; `normal`: the interpolated one.
void stretchLobe(inout Surface s, TexturePlace place, mat3 linear, float turned, vec3 normal) {
    s.along = vec3(0);
    s.stretch = 0.0;
    if (!isStretched(s.material)) return;
    vec3 tangent, bitangent;
    if (!tangentSpace(s.material, place, linear, turned, normal, tangent, bitangent)) return;
    const vec3 parts = stretch(s.material, place), raw = tangent * parts.x + bitangent * parts.y;
    const vec3 flat_part = raw - s.normal * dot(raw, s.normal);
    if (dot(flat_part, flat_part) == 0.0) return;
    s.along = normalize(flat_part);
    s.stretch = clamp(parts.z, 0.0, 1.0);
}

/// How much the corners' normals turn per world unit along the edges, their mean; > 0: a bulge.
float curvatureOf(vec3 a, vec3 b, vec3 c, vec3 na, vec3 nb, vec3 nc) {
    const vec3 ab = b - a, bc = c - b, ca = a - c;
    const float way = dot(ab, ab) + dot(bc, bc) + dot(ca, ca);
    return way > 0.0 ? (dot(nb - na, ab) + dot(nc - nb, bc) + dot(na - nc, ca)) / way : 0.0;
}

/// `width`: of the light that the ray along `direction` stands for (cone.glsl); 0: a point, which textures do not blur.
Surface surfaceAt(uint instance, uint triangle, vec2 uv, vec3 direction, float width) {
    Surface s;
    const uvec3 corners = triangles[triangle];
    vec3 a = positions[corners.x], b = positions[corners.y], c = positions[corners.z];
    vec3 na = normals[corners.x], nb = normals[corners.y], nc = normals[corners.z];
    vec3 reach = max(abs(a), max(abs(b), abs(c)));
    float turned = 1.0;
    mat3 linear = mat3(1);
    if (instances[instance].moved != 0u) {
        const GpuTransform to_world = instances[instance].to_world;
        const mat3 m = linear = to_world.linear;
        reach = mat3(abs(m[0]), abs(m[1]), abs(m[2])) * reach + abs(to_world.position);
        a = placedFrom(to_world, a, vec3(0));
        b = placedFrom(to_world, b, vec3(0));
        c = placedFrom(to_world, c, vec3(0));
        turned = instances[instance].mirrored != 0u ? -1.0 : 1.0;
        const mat3 cofactors = turned * mat3(cross(m[1], m[2]), cross(m[2], m[0]), cross(m[0], m[1]));
        na = placedNormal(cofactors, na);
        nb = placedNormal(cofactors, nb);
        nc = placedNormal(cofactors, nc);
    }
    uv = clamp(uv, vec2(0), vec2(1));  // planar hits may lie beside their triangle
    const vec3 weights = vec3(max(0.0, 1.0 - uv.x - uv.y), uv);
    s.position = a * weights.x + b * weights.y + c * weights.z;
    s.error = largest(reach) * POSITION_ROUNDING;
    s.offset = frame[0].surface_offset * instances[instance].voxel + frame[0].tolerance;
    const vec3 cross_product = turned * cross(b - a, c - a);
    const float size = length(cross_product);
    const vec3 interpolated = na * weights.x + nb * weights.y + nc * weights.z;
    const vec3 normal = dot(interpolated, interpolated) > 0.0 ? normalize(interpolated) : vec3(0, 1, 0);
    s.geometric = size > 0.0 ? cross_product / size : normal;
    s.front = dot(s.geometric, direction) < 0.0;
    if (!s.front) s.geometric = -s.geometric;
    // The interpolated normal may disagree with the winding in careless files: it follows the triangle. One that lies in
    // the triangle's plane stays, whatever rounding makes of its side.
    const float side = dot(normal, s.geometric) < -NORMAL_IN_PLANE ? -1.0 : 1.0;
    TexturePlace place = TexturePlace(corners, weights, 0.0);
    s.curvature = 0.0;
    if (filtered) {
        if (size > 0.0) place.seen = width * width / (max(abs(dot(s.geometric, direction)), LEAST_COSINE) * size);
        s.curvature = side * curvatureOf(a, b, c, na, nb, nc);
    }
    s.material = triangle_materials[triangle];
    const vec3 bent = bentNormal(s.material, TEXTURE_NORMAL, place, linear, turned, interpolated, normal);
    s.normal = visibleNormal(bent * side, s.geometric, -direction);
    s.coat_normal = s.normal;
    if (isCoated(s.material)) {
        const vec3 coat = bentNormal(s.material, TEXTURE_COAT_NORMAL, place, linear, turned, interpolated, normal);
        s.coat_normal = visibleNormal(coat * side, s.geometric, -direction);
    }
    stretchLobe(s, place, linear, turned, interpolated);
    s.shadow_start = shadowStart(s.position, a, b, c, na * side, nb * side, nc * side, s.geometric, weights);
    const vec4 color = baseColor(s.material, place);
    s.base_color = color.rgb;
    s.alpha = color.a;
    s.factors = textureFactors(s.material, place);
    return s;
}

vec3 environmentTexel(uint level_offset, uvec2 size, int x, int y) {
    const uint column = uint((x + int(size.x)) % int(size.x)), row = uint(clamp(y, 0, int(size.y) - 1));
    return lookups[TABLES_END + level_offset + row * size.x + column].rgb;
}

/// A picture among the environment's texels.
vec3 environmentPicture(vec2 uv, uint offset, uvec2 size) {
    const vec2 p = uv * vec2(size) - 0.5, f = fract(p);
    const ivec2 i = ivec2(floor(p));
    const vec3 top = mix(environmentTexel(offset, size, i.x, i.y), environmentTexel(offset, size, i.x + 1, i.y), f.x);
    const vec3 bottom = mix(environmentTexel(offset, size, i.x, i.y + 1), environmentTexel(offset, size, i.x + 1, i.y + 1), f.x);
    return mix(top, bottom, f.y);
}

vec3 environmentLevel(vec2 uv, uint level) {
    uint offset = 0u;
    uvec2 size = frame[0].env_size;
    for (uint i = 0u; i < level; i++) {
        offset += size.x * size.y;
        size = max(size / 2u, uvec2(1));
    }
    return environmentPicture(uv, offset, size);
}

/// Radiance of the environment along a unit direction, without the sun's disc; `level`: 0 the finest, at most the last.
vec3 environmentAt(vec3 d, float level) {
    const vec2 uv = equirectangular(d);
    const uint lower = uint(level);
    const vec3 sharp = environmentLevel(uv, lower);
    const float part = level - float(lower);
    return part > 0.0 ? mix(sharp, environmentLevel(uv, min(lower + 1u, frame[0].env_levels - 1u)), part) : sharp;
}

/// `blur` in [0, 1]: roughness.
vec3 environmentRadiance(vec3 d, float blur) { return environmentAt(d, blur * float(frame[0].env_levels - 1u)); }

/// The level whose texels are as wide as a cone that grows by `spread` (cone.glsl).
float environmentLevelOf(float spread) {
    return clamp(log2(max(abs(spread) * frame[0].env_texels, 1.0)), 0.0, float(frame[0].env_levels - 1u));
}

vec3 sunDisc(vec3 d) { return dot(d, frame[0].sun_direction) >= frame[0].sun_cosine ? frame[0].sun_radiance : vec3(0); }

vec3 skyRadiance(vec3 d, bool sees_sun) {
    vec3 radiance = environmentRadiance(d, 0.0);
    if (!sees_sun) radiance *= min(1.0, frame[0].rough_limit / max(largest(radiance), 1e-30));
    return sees_sun ? radiance + sunDisc(d) : radiance;
}

/// Irradiance of the environment on a surface with this normal, from spherical harmonics.
vec3 environmentIrradiance(vec3 n) {
    vec3 sum = frame[0].irradiance[0];
    sum += frame[0].irradiance[1] * n.y + frame[0].irradiance[2] * n.z + frame[0].irradiance[3] * n.x;
    sum += frame[0].irradiance[4] * (n.x * n.y) + frame[0].irradiance[5] * (n.y * n.z) + frame[0].irradiance[6] * (3.0 * n.z * n.z - 1.0) +
           frame[0].irradiance[7] * (n.x * n.z) + frame[0].irradiance[8] * (n.x * n.x - n.y * n.y);
    return max(sum, vec3(0));
}

/// Light left after a ray of this RayState::medium went the distance `t` (Beer and Lambert).
vec3 transmittance(uint medium, float t) {
    medium &= RAY_MEDIUM;
    return medium == MEDIUM_NONE ? vec3(1) : exp(-materialAbsorption(medium) * t);
}

/// A ray along `direction` as far as `reach` from the point `start` of a surface. It starts off the triangle's plane by the
/// position's error (Wächter, Binder: A Fast and Robust Method for Avoiding Self-Intersection, Ray Tracing Gems, ch. 6).
/// Planar hits know surfaces to a voxel only: there a ray counts from where it is Surface::offset above the plane. It
/// stays on its line until then, unless it is so flat that it would miss too much: then it is lifted as well.
Ray leavingRay(Surface s, vec3 start, vec3 direction, float reach) {
    const float slope = dot(direction, s.geometric);
    const float first = min(s.offset / max(abs(slope), LEAST_SLOPE), FLATTEST_START * s.offset);
    const float lift = s.error + (s.offset - first * abs(slope));
    return Ray(start + s.geometric * (slope >= 0.0 ? lift : -lift), first, direction, reach);
}

/// A ray from the smooth surface that the normals describe to a light that this surface faces. The triangle may turn away from the
/// light all the same: then the ray starts on the viewer's side, as always, and passes the triangle's plane farther on.
Ray shadowRay(Surface s, vec3 direction, float reach) {
    if (dot(direction, s.geometric) >= 0.0) return leavingRay(s, s.shadow_start, direction, reach);
    return Ray(s.shadow_start + s.geometric * (s.error + s.offset), 0.0, direction, reach);
}

/// Does that ray pass through the triangle `from` where it starts? On a bulge it passes the plane beside it; elsewhere the triangle is in
/// the light's way, which comes from behind.
bool blocksItself(Surface s, SurfaceId from, vec3 direction) {
    const float slope = dot(direction, s.geometric);
    if (slope >= 0.0) return false;
    const vec3 crossing = s.shadow_start - direction * (dot(s.shadow_start - s.position, s.geometric) / slope);
    vec3 a, b, c;
    placedTriangle(from.instance, from.triangle, crossing, a, b, c);
    const vec3 n = cross(b - a, c - a), weights = vec3(dot(cross(b, c), n), dot(cross(c, a), n), dot(cross(a, b), n));
    return min(weights.x, min(weights.y, weights.z)) >= -OWN_TRIANGLE_RIM * dot(n, n);
}

#endif
