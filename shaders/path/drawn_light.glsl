// Light that hits draw rather than sum up: of the environment, an emitter, one of many lamps. A part of scatter.comp; include after its
// arrivingLight() and isBlocked().
#ifndef PEELRAY_DRAWN_LIGHT_GLSL
#define PEELRAY_DRAWN_LIGHT_GLSL

/// Light that is drawn rather than summed up.
struct DrawnLight {
    LightSample environment, emitter, lamp;
    float reach;      ///< distance to the emitter
    uint lamp_index;
};
const DrawnLight NO_DRAWN_LIGHT = DrawnLight(LightSample(vec3(0), vec3(0)), LightSample(vec3(0), vec3(0)), LightSample(vec3(0), vec3(0)), 0.0, 0u);

/// The k-th light that counts by itself.
uint lampIndex(uint k) { return many_lamps && k >= frame[0].first_drawn ? k + frame[0].drawn_lamps : k; }

/// The first lamp of those of which one is drawn whose cumulative probability is above a number; `probability`: its own.
uint triedLamp(float random, out float probability) {
    uint first = frame[0].first_drawn, last = first + frame[0].drawn_lamps - 1u;
    [[dont_unroll]] while (first < last) {
        const uint middle = (first + last) / 2u;
        if (lights[middle].cumulative > random)
            last = middle;
        else
            first = middle + 1u;
    }
    probability = lights[first].cumulative - (first > frame[0].first_drawn ? lights[first - 1u].cumulative : 0.0);
    return first;
}

/// One of many lamps, for all of them (Talbot et al.: Importance Resampling for Global Illumination, 2005): lamps are tried by their
/// intensity, and one of them is taken by what each would bring.
void drawLamp(Surface s, Material m, Shade shade, vec3 view, SurfaceId from, uint seed, inout DrawnLight found) {
    const vec2 random = randomAt(seed, RANDOM_LAMP_CHOICE);
    float sum = 0.0, choice = random.y;
    vec3 light = vec3(0);
    [[dont_unroll]] for (uint k = 0u; k < LAMPS_TRIED; k++) {
        float probability;
        const uint index = triedLamp((float(k) + random.x) / float(LAMPS_TRIED), probability);
        vec3 direction;
        const vec3 tried = arrivingLight(index, s, m, shade, view, from, seed, direction);
        const float bright = abs(tried.r) + abs(tried.g) + abs(tried.b);
        if (bright == 0.0 || probability == 0.0) continue;
        const float weight = bright / probability;
        sum += weight;
        const float part = weight / sum;
        if (choice < part) {
            choice /= part;
            light = tried / bright;
            found.lamp_index = index;
            found.lamp.direction = direction;
        } else {
            choice = (choice - part) / (1.0 - part);
        }
    }
    found.lamp.light = light * (sum / float(LAMPS_TRIED));
}

/// Its light if no shadow ray is needed, one of which is counted otherwise.
vec3 unlessTraced(inout LightSample found, Surface s, Shade shade, SurfaceId from, inout uint rays) {
    if (found.light == vec3(0)) return vec3(0);
    if ((frame[0].effects & EFFECT_SHADOW) == 0u) return found.light;
    if (isBlocked(s, shade, from, found.direction))
        found.light = vec3(0);
    else
        rays++;
    return vec3(0);
}

#endif
