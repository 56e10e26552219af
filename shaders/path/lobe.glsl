// The microfacets of a rough surface, GGX. Include after frame.glsl.
#ifndef PEELRAY_LOBE_GLSL
#define PEELRAY_LOBE_GLSL

#include "path/shading.glsl"

struct Lobe {
    vec3 normal;
    vec3 along;       ///< tangent along which alpha.x counts; unused where both are the same
    vec2 alpha;
    float roughness;  ///< perceptual; of a stretched lobe that of a round one of the same area
    float mean_roughness;  ///< that of a round one that masks the view as much
    float straight;   ///< how much of the mean microfacet is the normal
    bool round;
};

/// Is it a mirror?
bool isMirror(Lobe lobe) { return lobe.roughness < MIRROR_ROUGHNESS; }

Lobe roundLobe(vec3 normal, float roughness) { return Lobe(normal, vec3(0), vec2(roughness * roughness), roughness, roughness, 1.0, true); }

/// Of a surface below its coat (KHR_materials_anisotropy); `view`: towards the viewer.
Lobe lobeOf(Surface s, Material m, vec3 view) {
    Lobe lobe = roundLobe(s.normal, m.roughness);
    if (!stretched || s.stretch == 0.0) return lobe;
    const float narrow = max(lobe.alpha.y, MIRROR_ROUGHNESS * MIRROR_ROUGHNESS);
    lobe.alpha = vec2(mix(narrow, 1.0, s.stretch * s.stretch), narrow);
    lobe.along = s.along;
    lobe.roughness = max(sqrt(sqrt(lobe.alpha.x * lobe.alpha.y)), MIRROR_ROUGHNESS);  // rounding makes no mirror
    const vec2 across = vec2(dot(view, s.along), dot(view, cross(s.normal, s.along))), wide = lobe.alpha * across;
    const float across2 = dot(across, across);
    lobe.mean_roughness = sqrt(sqrt(across2 > 0.0 ? dot(wide, wide) / across2 : 0.5 * dot(lobe.alpha, lobe.alpha)));
    const float straight = 1.0 - s.stretch * (1.0 - m.roughness), straight2 = straight * straight;
    lobe.straight = straight2 * straight2;
    lobe.round = false;
    return lobe;
}

/// In the frame of a stretched lobe.
vec3 within(Lobe lobe, vec3 v) { return vec3(dot(v, lobe.along), dot(v, cross(lobe.normal, lobe.along)), dot(v, lobe.normal)); }

/// Smith's masking; 0 below the surface.
float masking(Lobe lobe, vec3 direction) {
    const float cosine = dot(direction, lobe.normal);
    if (cosine <= 0.0) return 0.0;
    if (!stretched || lobe.round) return ggxMasking(cosine, lobe.alpha.x);
    return ggxMasking(within(lobe, direction), lobe.alpha);
}

/// How densely sampleMicrofacet() sends light of `view` where `h` mirrors it to, per steradian; of a mirror it tells nothing.
float lobeDensity(Lobe lobe, vec3 view, vec3 h) {
    const float n_v = max(GRAZING_COSINE, dot(lobe.normal, view)), n_h = clamp(dot(lobe.normal, h), 0.0, 1.0);
    if (!stretched || lobe.round) return ggxDistribution(n_h, lobe.alpha.x) * ggxMasking(n_v, lobe.alpha.x) / (4.0 * n_v);
    return ggxDistribution(vec3(within(lobe, h).xy, n_h), lobe.alpha) * ggxMasking(vec3(within(lobe, view).xy, n_v), lobe.alpha) / (4.0 * n_v);
}

/// What the lobe sends from `to_light` to `view`, times the cosine; less Fresnel's share. `h`: half-way between them.
float highlight(Lobe lobe, vec3 view, vec3 to_light, vec3 h) {
    return isMirror(lobe) || dot(lobe.normal, to_light) <= 0.0 ? 0.0 : lobeDensity(lobe, view, h) * masking(lobe, to_light);
}

/// The half vector of the one direction that stands for all of the lobe: the normal, of a stretched lobe turned to where the light of
/// its streak comes from (the glTF Sample Viewer's rule).
vec3 meanMicrofacet(Lobe lobe, vec3 view) {
    if (!stretched || lobe.round) return lobe.normal;
    const vec3 across = cross(lobe.normal, lobe.along), facing = view - across * dot(view, across);
    return directionOr(mix(directionOr(facing, lobe.normal), lobe.normal, lobe.straight), lobe.normal);
}

/// A visible normal; `random` in [0, 1).
vec3 sampleMicrofacet(Lobe lobe, vec3 view, vec2 random) {
    vec3 t, b;
    if (!stretched || lobe.round) {
        tangents(lobe.normal, t, b);
    } else {
        t = lobe.along;
        b = cross(lobe.normal, t);
    }
    const vec3 local = vec3(dot(view, t), dot(view, b), max(GRAZING_COSINE, dot(view, lobe.normal)));
    const vec3 h = sampleGgx(normalize(local), lobe.alpha, random);
    return normalize(t * h.x + b * h.y + lobe.normal * h.z);
}

#endif
