// Light from lamps, the sun and the sky (docs/frame.md section 5).
#include <algorithm>
#include <cmath>

#include "reference/lamp_shape.h"
#include "reference/optics.h"
#include "reference/shader.h"
#include "reference/sheen.h"

namespace peelray::inline PRECISION {

using namespace optics;

namespace {

/// The lobe of GGX, times the cosine; less Fresnel's share.
real highlight(const Lobe& lobe, const Vec3& view, const Vec3& to_light) {
    return lobe.density(view, to_light) * lobe.masking(to_light);
}

}  // namespace

Shader::Seen Shader::seen(const Surface& s, const Path& path) const {
    const Optics& m = s.optics;
    Seen seen;
    seen.n_v = std::clamp(-glm::dot(path.direction, s.normal), 0.0, 1.0);
    seen.coat = context_.albedos.coat(s, -glm::dot(path.direction, s.coat_normal));
    seen.sheen = below_sheen(s, seen.n_v);
    if (m.metallic == 1 || m.transmission == 1) return seen;
    // The share that scatter() gives to the reflection.
    const bool rough = m.lobe_roughness() >= MIRROR_ROUGHNESS;
    Vec3 mirrored = rough && !m.transmits() ? mean_reflectance(s, seen.n_v).dielectric
                                            : m.wall_reflectance(seen.n_v, m.leaves(s.front), Channel::green);
    if (rough && m.transmits() && !compensates(m)) mirrored *= context_.albedos.at(s, seen.n_v).masking();
    seen.scattered = 1 - largest(mirrored);
    return seen;
}

/// The lobe's share of a lamp's light, times the cosine; `density`: of the lobe towards it, `fresnel`: what its
/// microfacet reflects.
Vec3 Shader::specular(const Surface& s, const Path& path, const Lobe& lobe, real density, const Parts& fresnel,
                      real n_v, const Vec3& to_light) const {
    const Optics& m = s.optics;
    const real kept = lobe.masking(to_light), shape = density * kept;
    const bool sampled = context_.sampled();
    const Parts gained = fresnel * compensation(s, n_v);
    if (!m.transmits() || !compensates(m) || !sampled) return gained.of(m) * shape;
    const Vec3 half = glm::normalize(to_light - path.direction);
    const auto onward = m.thin ? std::optional(to_light - 2 * glm::dot(to_light, s.normal) * s.normal)
                               : refract_ray(path.direction, half, m.leaves(s.front) ? 1 / m.ior : m.ior);
    const Shares glass = rough_glass(fresnel.dielectric, kept, onward ? lobe.masking(-*onward) : 0);
    return glm::mix(glass.reflected / kept, gained.metal, m.metallic) * shape;
}

/// Reflected share of light from `to_light`, times the cosine: Lambert below GGX, both below the sheen, all below the
/// coat. From behind, light comes through as by Lambert's law. Lamps do not disperse: the middle index counts.
Vec3 Shader::reflectance(const Surface& s, const Path& path, const Seen& seen, const Vec3& to_light) const {
    const Optics& m = s.optics;
    const Vec3 view = -path.direction, half = glm::normalize(view + to_light);
    const real n_l = glm::dot(s.normal, to_light), v_h = std::clamp(glm::dot(view, half), 0.0, 1.0);
    const real diffuse = (1 - m.metallic) * (1 - m.transmission) / pi;
    if (m.behind > 0 && n_l < 0)
        return diffuse * m.behind * seen.scattered * seen.sheen * (1 - seen.coat) * m.behind_color * -n_l;
    Vec3 share(0);
    if (n_l > 0) {
        const bool leaving = m.leaves(s.front);
        const Parts fresnel{m.wall_reflectance(v_h, leaving, Channel::green),
                            m.metal_reflectance(v_h, leaving, Channel::green)};
        share = diffuse * (1 - m.behind) * (1 - largest(fresnel.dielectric)) * m.base_color * n_l;
        if (!photons_bring_lobe(m, path)) {
            const Lobe lobe = lobe_of(s);
            share += specular(s, path, lobe, lobe.density(view, to_light), fresnel, seen.n_v, to_light);
        }
        if (largest(m.sheen) > 0) {
            share *= std::min(seen.sheen, below_sheen(s, n_l));
            share += m.sheen * sheen::lobe(sheen::alpha_of(m.sheen_roughness), glm::dot(s.normal, half),
                                           std::max(GRAZING_COSINE, seen.n_v), n_l);
        }
    }
    if (m.clearcoat == 0) return share;
    share *= 1 - seen.coat;
    if (photons_bring_coat(m, path)) return share;
    return share + coat_reflectance(m, v_h) * highlight(coat_lobe(s), view, to_light);
}

/// `sky`: that of the environment where no direction to it is drawn, which else a diffuse ray brings.
Vec3 Shader::direct_light(const Lit& at, bool sky) {
    Vec3 sum(0);
    for (uint32_t i = 0; i < context_.lights.size(); i++) {
        if (context_.draws_lamps() && i - context_.lamps.first < context_.lamps.count) continue;
        const LampLight found = lamp_light(i, at);
        if (found.light != Vec3(0)) sum += found.light * lamp_visibility(found, at);
    }
    if (context_.draws_lamps()) sum += drawn_lamp(at);
    if (context_.samples_emitters()) sum += emitter_light(at);
    if (context_.samples_environment()) return sum + environment_light(at);
    return sky ? sum + sky_light(at) : sum;
}

/// What a lamp would bring.
Shader::LampLight Shader::lamp_light(uint32_t index, const Lit& at) const {
    const auto [irradiance, direction] = incidence(context_.lights[index], index, at);
    if (irradiance == Vec3(0)) return {index, direction, Vec3(0)};
    return {index, direction, irradiance * reflectance(at.surface, at.path, at.seen, direction)};
}

Vec3 Shader::lamp_visibility(const LampLight& found, const Lit& at) {
    const Start start = start_to(at, found.direction);
    return arriving(at, start, found.direction, reach(context_.lights[found.index], start.point, found.direction),
                    context_.glass_is_opaque);
}

/// One of many lamps for all: of some that are tried, one in proportion to what each would bring over how likely it was
/// tried (Talbot et al. 2005). What the surface's own triangle hides is not tried.
Vec3 Shader::drawn_lamp(const Lit& at) {
    const Vec2 u = random(at.path, RANDOM_LAMP_CHOICE);
    const std::vector<float>& cumulative = context_.lamps.cumulative;
    LampLight drawn{};
    real sum = 0, scale = 0, choice = u.y;
    for (int k = 0; k < LAMPS_TRIED; k++) {
        const auto chosen = std::upper_bound(cumulative.begin(), cumulative.end() - 1, float((k + u.x) / LAMPS_TRIED));
        const real probability = *chosen - (chosen == cumulative.begin() ? 0.0f : *(chosen - 1));
        const LampLight tried = lamp_light(context_.lamps.first + uint32_t(chosen - cumulative.begin()), at);
        const Vec3 light = glm::abs(tried.light);
        const real bright = light.x + light.y + light.z;
        if (probability == 0 || bright == 0 || hides_itself(at, tried.direction)) continue;
        sum += bright / probability;
        const real part = bright / probability / sum;
        const bool taken = choice < part;
        choice = taken ? choice / part : (choice - part) / (1 - part);
        if (!taken) continue;
        drawn = tried;
        scale = 1 / bright;
    }
    return sum > 0 ? drawn.light * (scale * sum / LAMPS_TRIED) * lamp_visibility(drawn, at) : Vec3(0);
}

/// Of a lamp with a size, from one of the directions in which it is seen; `index`: of the lamp.
Shader::Incidence Shader::incidence(const Light& light, uint32_t index, const Lit& at) const {
    const real radius = radius_of(light);
    Incidence in{light.color, -Vec3(light.direction)};
    real sine = std::sin(radius);  // of half the angle in which the lamp is seen
    if (light.kind != Light::Kind::directional) {
        const Vec3 to_light = Vec3(light.position) - at.surface.position;
        const real distance = glm::length(to_light);
        if (distance == 0) return {};
        in.direction = to_light / distance;
        sine = std::min(1.0, radius / distance);
        in.irradiance *= 1 / (distance * distance) * within_range(light, distance) * within_cone(light, -in.direction);
    }
    if (sine == 0 || in.irradiance == Vec3(0)) return in;
    const Vec2 u = random(at.path, RANDOM_LAMP + index);
    const real least = std::sqrt(1 - sine * sine), cosine = 1 - u.x * (1 - least), phi = 2 * pi * u.y;
    const real across = std::sqrt(1 - cosine * cosine);
    const auto [t, b] = tangents(in.direction);
    in.direction = t * (across * std::cos(phi)) + b * (across * std::sin(phi)) + in.direction * cosine;
    in.irradiance *= 2 / (1 + least);  // a ball's light from all over its disc, as from its cone
    return in;
}

/// How far a ray along a direction that incidence() has found goes up to the lamp: to the near side of its ball.
real Shader::reach(const Light& light, const Vec3& start, const Vec3& direction) const {
    if (light.kind == Light::Kind::directional) return endless;
    const Vec3 to_light = Vec3(light.position) - start;
    const real radius = radius_of(light), along = glm::dot(to_light, direction);
    const real inside2 = radius * radius - glm::dot(to_light, to_light) + along * along;
    return radius > 0 ? along - std::sqrt(std::max(0.0, inside2)) : along;
}

Shader::Start Shader::start_to(const Lit& at, const Vec3& direction) {
    const Surface& s = at.surface;
    const bool from_behind = s.optics.behind > 0 && glm::dot(s.normal, direction) < 0;
    return {from_behind ? s.start(s.position, direction) : s.lit_start(), from_behind};
}

/// A triangle that turns away from the light is itself in the way where it is no part of a bulge.
bool Shader::hides_itself(const Lit& at, const Vec3& direction) const {
    const Surface& s = at.surface;
    const bool from_behind = s.optics.behind > 0 && glm::dot(s.normal, direction) < 0;
    return context_.settings.shadow && !from_behind && context_.surfaces.blocks_itself(s, at.triangle, direction);
}

/// Share of the light that arrives from as far away.
Vec3 Shader::arriving(const Lit& at, const Start& start, const Vec3& direction, real distance, bool opaque_glass) {
    if (!context_.settings.shadow) return Vec3(1);
    if (hides_itself(at, direction)) return Vec3(0);
    rays_.shadow++;
    return visibility(start.point, direction, distance, at.triangle, start.from_behind ? at.behind : at.path.media,
                      opaque_glass);
}

/// Of a surface that is to show nothing but shadows: the share of its light that arrives, of all lamps, also those that
/// stand for a part of a sampled image, and of the sky. Directions drawn by an environment's brightness would make that
/// share noisy even where all arrives: one drawn by the cosine tells whether the sky is seen.
Vec3 Shader::left_by_shadows(const Lit& at) {
    const Surface& s = at.surface;
    const PictureSettings& settings = context_.settings;
    const Vec3 sky = scattered(at).front * context_.surroundings.irradiance(s.normal);
    Vec3 all = sky, light = sky;
    if (context_.filters_environment() && occludes_sky(settings)) {
        light = filtered_sky(at, {sky, Vec3(0)});
    } else if ((settings.ambient || (context_.samples_environment() && settings.shadow)) && largest(sky) > 0) {
        const Vec3 sampled = cosine_direction(s.normal, random(at.path, RANDOM_SKY));
        const Vec3 direction = above_surface(sampled, s.geometric);
        rays_.ambient++;
        light *= visibility(s.start(s.shadow_start, direction), direction, endless, at.triangle, at.path.media);
    }
    for (uint32_t i = 0; i < context_.all_lights.size(); i++) {
        const Light& lamp = context_.all_lights[i];
        const auto [irradiance, direction] = incidence(lamp, i, at);
        if (irradiance == Vec3(0)) continue;
        const Vec3 reflected = irradiance * reflectance(s, at.path, at.seen, direction);
        if (reflected == Vec3(0)) continue;
        const Start start = start_to(at, direction);
        all += reflected;
        light += reflected * arriving(at, start, direction, reach(lamp, start.point, direction),
                                      context_.glass_is_opaque && i < context_.lights.size());
    }
    light += caustic_light(at);
    Vec3 left(1);
    for (int c = 0; c < 3; c++)
        if (all[c] > 0) left[c] = light[c] / all[c];
    return left;
}

/// What the surface mirrors is not available for diffuse light.
Vec3 Shader::sky_light(const Lit& at) {
    const Surface& s = at.surface;
    const Optics& m = s.optics;
    auto [front, back] = scattered(at);
    if (largest(m.sheen) > 0) front += m.sheen * (1 - at.seen.coat) * context_.albedos.sheen(s, at.seen.n_v) / pi;
    const real open = occludes_sky(context_.settings) ? 1 : m.occlusion;  // or rays find out
    front *= open * context_.surroundings.irradiance(s.normal);
    back *= open * context_.surroundings.irradiance(-s.normal);
    if (!occludes_sky(context_.settings)) return front + back;
    if (context_.filters_environment()) return filtered_sky(at, {front, back});
    // One cosine-distributed direction per sample: its mean is the sky that the surface really sees.
    const Vec3 sampled = cosine_direction(s.normal, random(at.path, RANDOM_SKY));
    const Vec3 direction = above_surface(sampled, s.geometric);
    if (largest(front) > 0) {
        rays_.ambient++;
        front *= visibility(s.start(s.shadow_start, direction), direction, endless, at.triangle, at.path.media);
    }
    if (largest(back) > 0) {
        rays_.ambient++;
        back *= visibility(s.start(s.position, -direction), -direction, endless, at.triangle, at.behind);
    }
    return front + back;
}

/// Share of the light that arrives from `distance` away: 0 or 1, or the tint of the glass in between.
Vec3 Shader::visibility(const Vec3& start, const Vec3& direction, real distance, uint32_t triangle, Media media,
                        bool opaque_glass) const {
    Vec3 share(1);
    uint32_t skip = triangle;
    real from = 0;
    HitsAlong crossed;
    const Intersections::Way way = context_.triangles.way({start, 0, direction, distance}, skip, crossed);
    if (way != Intersections::Way::unsure) return Vec3(way == Intersections::Way::free);
    const MediaWalk walk = crossed.hits().empty() ? this->walk() : this->walk(&crossed);
    for (int layer = 0; layer < SHADOW_LAYERS; layer++) {
        Meeting meeting = walk.next({start, from, direction, distance}, skip, media, true);
        const Hit& hit = meeting.hit;
        share *= meeting.passed;
        if (!hit.hit()) return share;
        const Surface s = context_.surfaces.at(hit.triangle, hit.u, hit.v, direction);
        const Optics& m = s.optics;
        if ((opaque_glass || !m.transmits()) && m.alpha == 1) return Vec3(0);
        const real cosine = std::clamp(-glm::dot(direction, s.normal), 0.0, 1.0);
        Vec3 tint = (1.0 - reflectance_at(meeting, s, cosine, Channel::green).dielectric) * m.tint();
        if (opaque_glass) tint = Vec3(0);
        share *= glm::mix(Vec3(1), tint, m.alpha) * meeting.beside;
        // Light goes straight on: refraction would make it miss the lamp. Volumes absorb what crosses them.
        share *= transmittance(meeting.wall ? meeting.from : meeting.before.counting(context_.media), hit.t - from);
        if (largest(share) < LEAST_WEIGHT) return Vec3(0);
        from = meeting.beyond;
        skip = meeting.last;
        media = std::move(meeting.behind);
    }
    return Vec3(0);
}

}  // namespace peelray::inline PRECISION
