// Shading without bindings: Fresnel, microfacets, colour. Directions point away from the surface, all unit.
#ifndef PEELRAY_SHADING_GLSL
#define PEELRAY_SHADING_GLSL

#include "path/shading_numbers.h"

const float PI = 3.14159265358979;

vec3 srgbToLinear(vec3 c) { return mix(c / 12.92, pow((c + 0.055) / 1.055, vec3(2.4)), greaterThan(c, vec3(0.04045))); }
vec3 linearToSrgb(vec3 c) { return mix(c * 12.92, 1.055 * pow(max(c, vec3(1e-9)), vec3(1.0 / 2.4)) - 0.055, greaterThan(c, vec3(0.0031308))); }
float largest(vec3 c) { return max(c.r, max(c.g, c.b)); }
float luminance(vec3 c) { return dot(c, vec3(0.2126, 0.7152, 0.0722)); }

/// The angle of the vector (x, y) from the x axis, (-π, π], to 2·10⁻⁷. Vulkan lets atan be 1000 times as far off, and some drivers make use
/// of that: a tenth of a texel of an environment map, which shows beside the sun.
float angleOf(float y, float x) {
    const float ax = abs(x), ay = abs(y), longer = max(ax, ay);
    const float r = longer > 0.0 ? min(ax, ay) / longer : 0.0, r2 = r * r;
    // Minimax on [0, 1], fitted by Lawson's iteration.
    float a = 0.0024567225;
    a = a * r2 - 0.014401349;
    a = a * r2 + 0.039781209;
    a = a * r2 - 0.072348557;
    a = a * r2 + 0.104989454;
    a = a * r2 - 0.141612291;
    a = a * r2 + 0.199859068;
    a = a * r2 - 0.333325982;
    a = (a * r2 + 0.99999988) * r;
    if (ay > ax) a = 0.5 * PI - a;
    if (x < 0.0) a = PI - a;
    return y < 0.0 ? -a : a;
}

/// Where a direction is in an environment map, [0, 1].
vec2 equirectangular(vec3 d) { return vec2(0.5 + angleOf(d.x, -d.z) * (0.5 / PI), angleOf(length(d.xz), d.y) / PI); }

/// Unpolarised Fresnel reflectance of a dielectric; `cosine` ≥ 0 on the incoming side, `eta` = index behind / index before.
/// 1 at total internal reflection.
float fresnelDielectric(float cosine, float eta) {
    const float sine2 = (1.0 - cosine * cosine) / (eta * eta);
    if (sine2 >= 1.0) return 1.0;
    const float refracted = sqrt(1.0 - sine2);
    const float parallel = (eta * cosine - refracted) / (eta * cosine + refracted);
    const float perpendicular = (cosine - eta * refracted) / (cosine + eta * refracted);
    return 0.5 * (parallel * parallel + perpendicular * perpendicular);
}

/// From `f0` at normal incidence to `f90` at grazing angles.
vec3 fresnelSchlick(vec3 f0, float f90, float cosine) {
    const float m = clamp(1.0 - cosine, 0.0, 1.0), m2 = m * m;
    return f0 + (f90 - f0) * (m2 * m2 * m);
}

/// The refracted direction of `incoming` (towards the surface); false: total internal reflection.
bool refractRay(vec3 incoming, vec3 normal, float eta, out vec3 refracted) {
    const float cosine = -dot(incoming, normal);
    const float k = 1.0 - (1.0 - cosine * cosine) / (eta * eta);
    refracted = vec3(0);
    if (k < 0.0) return false;
    refracted = normalize(incoming / eta + normal * (cosine / eta - sqrt(k)));
    return true;
}

/// An interpolated normal that the viewer would see from behind is bent until it is just visible.
vec3 visibleNormal(vec3 normal, vec3 geometric, vec3 to_viewer) {
    const float cosine = dot(normal, to_viewer);
    if (cosine >= LEAST_COSINE) return normal;
    const vec3 bent = normal + to_viewer * (LEAST_COSINE - cosine);
    return dot(bent, bent) > 1e-12 ? normalize(bent) : geometric;
}

/// A reflected direction that would enter the surface is lifted to just above it.
vec3 aboveSurface(vec3 direction, vec3 geometric) {
    const float height = dot(direction, geometric);
    return height >= LEAST_COSINE ? direction : normalize(direction + geometric * (LEAST_COSINE - height));
}

float ggxDistribution(float n_h, float alpha) {
    const float a2 = alpha * alpha, k = n_h * n_h * (a2 - 1.0) + 1.0;
    return a2 / (PI * k * k);
}

/// Smith's masking of one direction, GGX.
float ggxMasking(float cosine, float alpha) {
    const float a2 = alpha * alpha;
    return 2.0 * cosine / (cosine + sqrt(a2 + (1.0 - a2) * cosine * cosine));
}

/// The same of a distribution that is as wide along x and y as `alpha` says; directions in the frame whose z is the normal.
float ggxDistribution(vec3 h, vec2 alpha) {
    const vec3 stretched = vec3(h.xy / alpha, h.z);
    const float k = dot(stretched, stretched);
    return 1.0 / (PI * alpha.x * alpha.y * k * k);
}
float ggxMasking(vec3 direction, vec2 alpha) {
    const vec2 across = alpha * direction.xy;
    return 2.0 * direction.z / (direction.z + sqrt(dot(across, across) + direction.z * direction.z));
}

/// A visible normal of the GGX distribution (Heitz: Sampling the GGX Distribution of Visible Normals, JCGT 2018).
/// `view` in the frame whose z is the normal; `random` in [0, 1).
vec3 sampleGgx(vec3 view, vec2 alpha, vec2 random) {
    const vec3 v = normalize(vec3(alpha * view.xy, view.z));
    const float length2 = v.x * v.x + v.y * v.y;
    const vec3 t1 = length2 > 0.0 ? vec3(-v.y, v.x, 0) / sqrt(length2) : vec3(1, 0, 0);
    const vec3 t2 = cross(v, t1);
    const float r = sqrt(random.x), phi = 2.0 * PI * random.y, s = 0.5 * (1.0 + v.z);
    const float p1 = r * cos(phi), p2 = mix(sqrt(max(0.0, 1.0 - p1 * p1)), r * sin(phi), s);
    const vec3 n = p1 * t1 + p2 * t2 + sqrt(max(0.0, 1.0 - p1 * p1 - p2 * p2)) * v;
    return normalize(vec3(alpha * n.xy, max(1e-6, n.z)));
}

vec3 sampleGgx(vec3 view, float alpha, vec2 random) { return sampleGgx(view, vec2(alpha), random); }

/// Distribution of the fibres' normals of a sheen (Estevez, Kulla: Production Friendly Microfacet Sheen BRDF, 2017).
float sheenDistribution(float n_h, float alpha) {
    const float inverse = 1.0 / alpha;
    return (2.0 + inverse) * pow(max(1.0 - n_h * n_h, 0.0), 0.5 * inverse) / (2.0 * PI);
}

/// Λ of its masking, by its authors' fit.
float sheenLambda(float cosine, float alpha) {
    const float part = (1.0 - alpha) * (1.0 - alpha);
    const vec3 abc = mix(vec3(21.5473, 3.82987, 0.19823), vec3(25.3245, 3.32435, 0.16801), part);
    const vec2 de = mix(vec2(-1.97760, -4.32054), vec2(-1.27393, -4.85967), part);
    const float x = max(cosine < 0.5 ? cosine : 1.0 - cosine, 0.0);  // rounding makes cosines above 1
    const float here = abc.x / (1.0 + abc.y * pow(x, abc.z)) + de.x * x + de.y;
    return exp(cosine < 0.5 ? here : 2.0 * (abc.x / (1.0 + abc.y * pow(0.5, abc.z)) + de.x * 0.5 + de.y) - here);
}

/// Tangents of a unit normal (Duff et al.: Building an Orthonormal Basis, Revisited, JCGT 2017).
void tangents(vec3 n, out vec3 t, out vec3 b) {
    const float s = n.z >= 0.0 ? 1.0 : -1.0, a = -1.0 / (s + n.z), c = n.x * n.y * a;
    t = vec3(1.0 + s * n.x * n.x * a, s * c, -s * n.x);
    b = vec3(c, s + n.y * n.y * a, -n.y);
}

/// A direction in front of a surface, its density the cosine over pi; `random` in [0, 1).
vec3 cosineDirection(vec3 normal, vec2 random) {
    vec3 t, b;
    tangents(normal, t, b);
    const float r = sqrt(random.x), phi = 2.0 * PI * random.y;
    return t * (r * cos(phi)) + b * (r * sin(phi)) + normal * sqrt(max(0.0, 1.0 - random.x));
}

/// pcg3d (Jarzynski, Olano: Hash Functions for GPU Rendering, JCGT 2020).
uvec3 hash3(uvec3 v) {
    v = v * 1664525u + 1013904223u;
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v ^= v >> 16u;
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    return v;
}

/// Tone curves; input exposed, linear; output linear in [0, 1].
vec3 tonemapAces(vec3 c) {  // Narkowicz: ACES filmic tone mapping curve, 2015
    c = min(c, vec3(1e6));  // white long before; squares would overflow
    return clamp((c * (2.51 * c + 0.03)) / (c * (2.43 * c + 0.59) + 0.14), vec3(0), vec3(1));
}
vec3 tonemapNeutral(vec3 c) {  // Khronos PBR neutral tone mapper, 2024
    const float x = min(c.r, min(c.g, c.b));
    const float offset = x < 0.08 ? x - 6.25 * x * x : 0.04;
    c -= offset;
    const float peak = largest(c), start = 0.8 - 0.04;
    if (peak < start) return c;
    const float d = 1.0 - start, compressed = 1.0 - d * d / (peak + d - start);
    c *= compressed / peak;
    const float g = 1.0 - 1.0 / (0.15 * (peak - compressed) + 1.0);
    return mix(c, vec3(compressed), g);
}

#endif
