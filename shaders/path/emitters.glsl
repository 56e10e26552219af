// Emissive triangles as lamps, chosen by their power (src/scene/emitters.h). Include after branches.glsl and environment_light.glsl.
#ifndef PEELRAY_EMITTERS_GLSL
#define PEELRAY_EMITTERS_GLSL

#include "path/environment_light.glsl"

vec4 emitter(uint index) { return lookups[frame[0].first_emitter + index]; }

/// The first whose cumulative probability is above the random number.
uint chooseEmitter(float random) {
    uint first = 0u, last = frame[0].emitters - 1u;
    [[dont_unroll]] while (first < last) {
        const uint middle = (first + last) / 2u;
        if (emitter(middle).z > random)
            last = middle;
        else
            first = middle + 1u;
    }
    return first;
}

/// Probability of a triangle being chosen; 0: it is none of them.
float emitterProbability(uint instance, uint triangle) {
    uint first = 0u, last = frame[0].emitters;
    [[dont_unroll]] while (first < last) {
        const uint middle = (first + last) / 2u;
        const uvec2 at = floatBitsToUint(emitter(middle).xy);
        if (at.x < instance || (at.x == instance && at.y < triangle))
            first = middle + 1u;
        else
            last = middle;
    }
    if (first == frame[0].emitters) return 0.0;
    const vec4 found = emitter(first);
    return floatBitsToUint(found.xy) == uvec2(instance, triangle) ? found.w : 0.0;
}

/// Of light being looked for where a ray along `direction` meets the triangle at the distance `t`, per steradian.
float emitterDensity(float probability, vec3 a, vec3 b, vec3 c, vec3 direction, float t) {
    const float projected = abs(dot(cross(b - a, c - a), direction));  // twice the area times the cosine
    return projected > 0.0 ? 2.0 * probability * t * t / projected : 0.0;
}

/// Of the emission of surface `s`, which a ray met at the distance `t`, what the ray is to bring: all, or less what is found otherwise.
/// `density`: RayState's.
float emissionShare(Surface s, SurfaceId id, vec3 direction, float t, float density) {
    if (density == 0.0) return 1.0;
    const float probability = emitterProbability(id.instance, id.triangle);
    if (probability == 0.0) return 1.0;
    if (density < 0.0) return 0.0;
    vec3 a, b, c;
    placedTriangle(id.instance, id.triangle, s.position, a, b, c);
    return density / (density + emitterDensity(probability, a, b, c, direction, t));
}

/// Light of one emissive triangle; `reach`: distance to it.
LightSample emitterLight(Surface s, Material m, Shade shade, vec3 view, SurfaceId from, float choice, vec2 random, out float reach) {
    LightSample result = LightSample(vec3(0, 0, 1), vec3(0));
    reach = 0.0;
    const vec4 chosen = emitter(chooseEmitter(choice));
    const SurfaceId id = SurfaceId(floatBitsToUint(chosen.x), floatBitsToUint(chosen.y));
    if (id == from) return result;
    const float root = sqrt(random.x);
    const vec2 uv = root * vec2(1.0 - random.y, random.y);
    vec3 a, b, c;
    placedTriangle(id.instance, id.triangle, s.position, a, b, c);
    const vec3 way = a + (b - a) * uv.x + (c - a) * uv.y;
    reach = length(way);
    if (reach == 0.0) return result;
    result.direction = way / reach;
    const float density = emitterDensity(chosen.w, a, b, c, result.direction, reach);
    if (density == 0.0) return result;
    const vec3 share = scatteredShare(s, m, shade, view, result.direction) / density + lobeLight(s, m, shade, view, result.direction, density);
    if (share == vec3(0) || !alphaPresent(id.triangle, uv)) return result;
    const Surface lamp = surfaceAt(id.instance, id.triangle, uv, result.direction, 0.0);
    const Material emissive = materialOf(lamp);
    if (!lamp.front && (emissive.flags & MATERIAL_SINGLE_SIDED) != 0u) return result;
    result.light = share * emissive.emissive * (lamp.alpha * (1.0 - coatShare(emissive, -dot(result.direction, lamp.coat_normal))));
    return result;
}

#endif
