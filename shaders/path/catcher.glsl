// Surfaces that show nothing but shadows and mirror images. A part of scatter.comp, whose Scattering it fills in.
#ifndef PEELRAY_CATCHER_GLSL
#define PEELRAY_CATCHER_GLSL

/// Is a ray to follow that tells whether a shadow catcher sees the sky? Where the environment is sampled, too: directions drawn by its
/// brightness would make the share of light that arrives noisy even where all does.
bool catchesSky() { return (frame[0].effects & (env_sampled ? EFFECT_AMBIENT | EFFECT_SHADOW : EFFECT_AMBIENT)) != 0u; }

/// A surface that is to show nothing but shadows leaves of what is behind it the share of its light that arrives: of all lamps, also those
/// that stand for a part of a sampled image, and of the sky. Its lights are in units of what is behind it over all light.
void catchShadows(Ray ray, RayState state, Material m, inout Scattering c, out uint sky_rays) {
    const bool open = frame[0].backdrop == BACKDROP_NONE && isStraight(state.medium, params.level);
    const vec3 view = -ray.direction, behind = open ? vec3(1) : missRadiance(ray.direction, state.medium, params.level, skyAlong(ray, state));
    const Shade shade = shadeOf(c.surface, m, view);
    vec3 all, below, light = vec3(0);
    skyLight(c.surface, m, shade, view, all, below);
    if (!catchesSky() || all == vec3(0)) {
        sky_rays = 0u;
        light = all;
    } else {
        sky_rays = env_filtered ? countSky(c.surface, shade, c.from, all, vec3(0), light) : 1u;
    }
    c.light_rays = sky_rays;
    for (uint k = 0u; k < frame[0].all_lights; k++) {
        vec3 direction;
        const vec3 arriving = arrivingLight(k, c.surface, m, shade, view, c.from, state.seed, direction);
        all += arriving;
        if ((frame[0].effects & EFFECT_SHADOW) == 0u)
            light += arriving;
        else if (arriving != vec3(0))
            c.light_rays++;
    }
    c.light_share = mix(behind / max(all, vec3(1e-30)), vec3(0), lessThanEqual(all, vec3(0)));
    c.node.radiance = mix(light * c.light_share, behind, lessThanEqual(all, vec3(0)));
    c.node.flags = NODE_CATCHER | (open ? NODE_SHARE : 0u);
}

/// Puts the shadow rays that catchShadows() counted into the queue from `slot` to `end`.
void emitCaught(uint slot, uint end, Surface s, vec3 view, vec3 share, MediaStack before, SurfaceId from, uint seed) {
    const Material m = materialOf(s);
    const Shade shade = shadeOf(s, m, view);
    vec3 sky, below;
    skyLight(s, m, shade, view, sky, below);
    if (!env_filtered && catchesSky() && sky != vec3(0)) emitLight(slot++, skyRay(s, seed, false), before, from, sky * share);
    if ((frame[0].effects & EFFECT_SHADOW) != 0u) {
        for (uint k = 0u; k < frame[0].all_lights; k++) {
            vec3 direction;
            const vec3 light = arrivingLight(k, s, m, shade, view, from, seed, direction);
            if (light == vec3(0)) continue;
            const bool sends = k < frame[0].lights + frame[0].drawn_lamps;  // photons
            emitLight(slot++, lampRay(k, s, direction, false), before, sends ? lampFrom(from) : from, light * share);
        }
    }
    if (env_filtered && catchesSky() && sky != vec3(0)) emitSky(slot, end - slot, s, shade, from, sky, vec3(0), share, before, before);
}

#endif
