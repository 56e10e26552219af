// Light from lamps, the sun and the sky (docs/frame.md section 5).
#include <algorithm>
#include <cmath>

#include "base/infinity.h"
#include "reference/optics.h"
#include "reference/shader.h"
#include "reference/sheen.h"

namespace peelray {

using namespace optics;

namespace {

/// A light as a point of a surface meets it.
struct Incidence {
    glm::dvec3 irradiance{0};  ///< on a surface that faces the light; 0: none
    glm::dvec3 direction;      ///< to the light, unit
};

Incidence incidence(const Light& light, const glm::dvec3& position) {
    if (light.kind == Light::Kind::directional) return {light.color, -glm::dvec3(light.direction)};
    const glm::dvec3 to_light = glm::dvec3(light.position) - position;
    const double distance = glm::length(to_light);
    if (distance == 0) return {};
    const glm::dvec3 direction = to_light / distance;
    // KHR_lights_punctual: inverse square with a smooth end at the range, a squared ramp between the cones.
    double strength = 1 / (distance * distance);
    if (std::isfinite(light.range)) strength *= std::clamp(1 - std::pow(distance / light.range, 4), 0.0, 1.0);
    if (light.kind == Light::Kind::spot) {
        const double inner = std::cos(double(light.inner_cone)), outer = std::cos(double(light.outer_cone));
        const double cosine = glm::dot(glm::dvec3(light.direction), -direction);
        const double ramp = std::clamp((cosine - outer) / std::max(0.001, inner - outer), 0.0, 1.0);
        strength *= ramp * ramp;
    }
    return {glm::dvec3(light.color) * strength, direction};
}

/// The lobe of GGX, times the cosine; less Fresnel's share.
double highlight(const Lobe& lobe, const glm::dvec3& view, const glm::dvec3& to_light) {
    const double n_l = glm::dot(lobe.n, to_light);
    if (n_l <= 0 || lobe.alpha.x < MIRROR_ROUGHNESS * MIRROR_ROUGHNESS) return 0;
    const double n_v = std::max(GRAZING_COSINE, glm::dot(lobe.n, view));
    return lobe.distribution(glm::normalize(view + to_light)) * lobe.masking(view) * lobe.masking(to_light) / (4 * n_v);
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
    glm::dvec3 mirrored = m.wall_reflectance(seen.n_v, m.leaves(s.front), Channel::green);
    if (m.lobe_roughness() >= MIRROR_ROUGHNESS) {
        if (!m.transmits())
            mirrored = mean_reflectance(s, seen.n_v).dielectric;
        else if (!compensates(m))
            mirrored *= context_.albedos.at(s, seen.n_v).masking();
    }
    seen.scattered = 1 - largest(mirrored);
    return seen;
}

/// The lobe's share of a lamp's light, times the cosine; `fresnel`: what its microfacet reflects.
glm::dvec3 Shader::specular(const Surface& s, const Path& path, const Parts& fresnel, double n_v,
                            const glm::dvec3& to_light) const {
    const Optics& m = s.optics;
    const Lobe lobe = lobe_of(s);
    const glm::dvec3 half = glm::normalize(to_light - path.direction);
    const double shape = highlight(lobe, -path.direction, to_light);
    const bool sampled = context_.settings.spp > 1;
    const Parts gained = fresnel * compensation(s, n_v);
    if (!m.transmits() || !compensates(m) || !sampled) return gained.of(m) * shape;
    const double kept = lobe.masking(to_light);
    const auto onward = m.thin ? std::optional(to_light - 2 * glm::dot(to_light, s.normal) * s.normal)
                               : refract_ray(path.direction, half, m.leaves(s.front) ? 1 / m.ior : m.ior);
    const Shares glass = rough_glass(fresnel.dielectric, kept, onward ? lobe.masking(-*onward) : 0);
    return glm::mix(glass.reflected / kept, gained.metal, m.metallic) * shape;
}

/// Reflected share of light from `to_light`, times the cosine: Lambert below GGX, both below the sheen, all below the
/// coat. From behind, light comes through as by Lambert's law. Lamps do not disperse: the middle index counts.
glm::dvec3 Shader::reflectance(const Surface& s, const Path& path, const Seen& seen, const glm::dvec3& to_light) const {
    const Optics& m = s.optics;
    const glm::dvec3 view = -path.direction, half = glm::normalize(view + to_light);
    const double n_l = glm::dot(s.normal, to_light), v_h = std::clamp(glm::dot(view, half), 0.0, 1.0);
    const double diffuse = (1 - m.metallic) * (1 - m.transmission) / pi;
    if (m.behind > 0 && n_l < 0)
        return diffuse * m.behind * seen.scattered * seen.sheen * (1 - seen.coat) * m.behind_color * -n_l;
    glm::dvec3 share(0);
    if (n_l > 0) {
        const bool leaving = m.leaves(s.front);
        const Parts fresnel{m.wall_reflectance(v_h, leaving, Channel::green),
                            m.metal_reflectance(v_h, leaving, Channel::green)};
        share = diffuse * (1 - m.behind) * (1 - largest(fresnel.dielectric)) * m.base_color * n_l;
        share += specular(s, path, fresnel, seen.n_v, to_light);
        if (largest(m.sheen) > 0) {
            share *= std::min(seen.sheen, below_sheen(s, n_l));
            share += m.sheen * sheen::lobe(sheen::alpha_of(m.sheen_roughness), glm::dot(s.normal, half),
                                           std::max(GRAZING_COSINE, seen.n_v), n_l);
        }
    }
    if (m.clearcoat == 0) return share;
    const double coat = m.clearcoat * fresnel_schlick(glm::dvec3(COAT_REFLECTANCE), 1, v_h).x;
    const Lobe lobe(s.coat_normal, m.coat_roughness * m.coat_roughness);
    return share * (1 - seen.coat) + coat * highlight(lobe, view, to_light);
}

glm::dvec3 Shader::direct_light(const Surface& s, uint32_t triangle, const Path& path, const Meeting& meeting) {
    const Optics& m = s.optics;
    if (m.unlit) return glm::dvec3(0);
    const Seen seen = this->seen(s, path);
    const Media& behind = meeting.wall && m.transmits() && !m.thin ? meeting.behind : path.media;
    glm::dvec3 sum(0);
    for (const Light& light : context_.lights) {
        const auto [irradiance, direction] = incidence(light, s.position);
        if (irradiance == glm::dvec3(0)) continue;
        const glm::dvec3 reflected = irradiance * reflectance(s, path, seen, direction);
        if (reflected == glm::dvec3(0)) continue;
        if (!context_.settings.shadow) {
            sum += reflected;
            continue;
        }
        const bool from_behind = m.behind > 0 && glm::dot(s.normal, direction) < 0;
        // A triangle that turns away from the light is itself in the way where it is no part of a bulge.
        if (!from_behind && context_.surfaces.blocks_itself(s, triangle, direction)) continue;
        rays_.shadow++;
        const glm::dvec3 start = from_behind ? s.start(s.position, direction) : s.lit_start();
        const bool far = light.kind == Light::Kind::directional;
        const double reach = far ? infinity : glm::dot(glm::dvec3(light.position) - start, direction);
        sum += reflected * visibility(start, direction, reach, triangle, from_behind ? behind : path.media);
    }
    return sum + sky_light(s, triangle, path, seen, behind);
}

/// What the surface mirrors is not available for diffuse light.
glm::dvec3 Shader::sky_light(const Surface& s, uint32_t triangle, const Path& path, const Seen& seen,
                             const Media& behind) {
    const Optics& m = s.optics;
    const glm::dvec3 below = glm::dvec3((1 - m.metallic) * (1 - m.transmission) / pi * seen.scattered * seen.sheen);
    glm::dvec3 front = below * (1 - m.behind) * m.base_color, back = below * m.behind * m.behind_color;
    if (largest(m.sheen) > 0) front += m.sheen * context_.albedos.sheen(s, seen.n_v) / pi;
    const double open = context_.settings.ambient ? 1 : m.occlusion;  // or rays find out
    front *= open * (1 - seen.coat) * context_.surroundings.irradiance(s.normal);
    back *= open * (1 - seen.coat) * context_.surroundings.irradiance(-s.normal);
    if (!context_.settings.ambient) return front + back;
    // One cosine-distributed direction per sample: its mean is the sky that the surface really sees.
    const glm::dvec3 sampled = cosine_direction(s.normal, random_pair(path.seed, sample_, Purpose::sky));
    const glm::dvec3 direction = above_surface(sampled, s.geometric);
    if (largest(front) > 0) {
        rays_.ambient++;
        front *= visibility(s.start(s.shadow_start, direction), direction, infinity, triangle, path.media);
    }
    if (largest(back) > 0) {
        rays_.ambient++;
        back *= visibility(s.start(s.position, -direction), -direction, infinity, triangle, behind);
    }
    return front + back;
}

/// Share of the light that arrives from `distance` away: 0 or 1, or the tint of the glass in between.
glm::dvec3 Shader::visibility(const glm::dvec3& start, const glm::dvec3& direction, double distance, uint32_t triangle,
                              Media media) const {
    glm::dvec3 share(1);
    uint32_t skip = triangle;
    double from = 0;
    for (int layer = 0; layer < SHADOW_LAYERS; layer++) {
        Meeting meeting = walk().next({start, from, direction, distance}, skip, media, true);
        const OracleHit& hit = meeting.hit;
        share *= meeting.passed;
        if (!hit.hit()) return share;
        const Surface s = context_.surfaces.at(hit.triangle, hit.u, hit.v, direction);
        const Optics& m = s.optics;
        if (!m.transmits() && m.alpha == 1) return glm::dvec3(0);
        const double cosine = std::clamp(-glm::dot(direction, s.normal), 0.0, 1.0);
        const glm::dvec3 tint = (1.0 - reflectance_at(meeting, s, cosine, Channel::green).dielectric) * m.tint();
        share *= glm::mix(glm::dvec3(1), tint, m.alpha) * meeting.beside;
        // Light goes straight on: refraction would make it miss the lamp. Volumes absorb what crosses them.
        share *= transmittance(meeting.wall ? meeting.from : meeting.before.counting(context_.media), hit.t - from);
        if (largest(share) < LEAST_WEIGHT) return glm::dvec3(0);
        from = meeting.beyond;
        skip = meeting.last;
        media = std::move(meeting.behind);
    }
    return glm::dvec3(0);
}

}  // namespace peelray
