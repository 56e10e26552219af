// The environment's light, found by sampling: one direction for each hit, drawn by the light's brightness or by what the surface
// scatters; rays that lobes send out find the rest (multiple importance sampling: Veach and Guibas 1995). Include after branches.glsl.
#ifndef PEELRAY_ENVIRONMENT_LIGHT_GLSL
#define PEELRAY_ENVIRONMENT_LIGHT_GLSL

#include "path/environment_density.glsl"
#include "path/lighting.glsl"

/// What arrives from a direction, if nothing is in its way.
struct LightSample {
    vec3 direction;
    vec3 light;  ///< that the surface sends towards the viewer
};

/// Takes the share below `part` of a random number for itself.
bool takePart(inout float u, float part) {
    const bool taken = u < part;
    u = min(taken ? u / part : (u - part) / (1.0 - part), 0.99999994);
    return taken;
}

/// Light by the lobes of base and coat, less what the rays that they send out find: over the density of directions.
vec3 lobeLight(Surface s, Material m, Shade shade, vec3 view, vec3 to_light, float density) {
    if (sharesBranch(s, m) || !samplesMicrofacets()) return vec3(0);
    const vec3 h = normalize(view + to_light);
    vec3 sum = vec3(0);
    if (dot(s.normal, to_light) > 0.0)
        sum = baseHighlight(s, m, shade, view, to_light, h) * (shade.below_sheen * shade.below_coat) /
              (density + tracedPart(shade.lobe.roughness, m.metallic) * lobeDensity(shade.lobe, view, h));
    if (!coated || m.clearcoat == 0.0) return sum;
    const Lobe coat = roundLobe(s.coat_normal, m.coat_roughness);
    return sum + coatHighlight(s, m, view, to_light, h) / (density + tracedPart(m.coat_roughness, 0.0) * lobeDensity(coat, view, h));
}

/// Does the surface send light into all directions?
bool scattersLight(Material m) { return (m.metallic < 1.0 && m.transmission < 1.0) || (sheened && m.sheen_color != vec3(0)); }

/// Share of the directions that scatteredDirection() takes behind the surface.
float shareBehind(Material m) { return seeping && m.metallic < 1.0 && m.transmission < 1.0 ? m.seeping_share : 0.0; }

/// A direction into which a surface scatters light, by the cosine; `random` in [0, 1).
vec3 scatteredDirection(Surface s, float behind, vec2 random) {
    const bool back = behind > 0.0 && takePart(random.x, behind);
    const vec3 direction = cosineDirection(s.normal, random);
    return back ? -direction : direction;
}

/// Its density per steradian.
float scatteredDensity(Surface s, float behind, vec3 direction) {
    const float cosine = dot(s.normal, direction);
    return (cosine > 0.0 ? 1.0 - behind : behind) * abs(cosine) / PI;
}

/// `random` in [0, 1).
LightSample environmentLight(Surface s, Material m, Shade shade, vec3 view, vec2 random) {
    const bool scatters = scattersLight(m);
    const float by_light = scatters ? 0.5 : 1.0, behind = shareBehind(m);
    LightSample result;
    const bool found = !scatters || takePart(random.x, by_light);
    result.direction = found ? environmentDirection(random) : scatteredDirection(s, behind, random);
    const float density = environmentDensity(result.direction);
    vec3 share = vec3(0);
    if (scatters)
        share = scatteredShare(s, m, shade, view, result.direction) / mix(scatteredDensity(s, behind, result.direction), density, by_light);
    if (found) share += lobeLight(s, m, shade, view, result.direction, density) / by_light;
    result.light = share == vec3(0) ? vec3(0) : share * environmentRadiance(result.direction, 0.0);
    return result;
}

#endif
