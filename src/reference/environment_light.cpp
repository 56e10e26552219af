// The environment's light on what is no mirror, by rays in directions drawn by its brightness and by the surface's
// lobes (docs/frame.md section 5).
#include <algorithm>
#include <cmath>

#include "reference/shader.h"
#include "reference/sheen.h"

namespace peelray {

using namespace optics;

/// What of the environment's light comes along a ray; the rest its hit has found by drawing directions to the
/// environment (Veach and Guibas, Optimally Combining Sampling Techniques, 1995: the balance heuristic).
double Shader::environment_share(const glm::dvec3& direction, double density) const {
    if (density == 0) return 1;
    return density < 0 ? 0 : density / (density + context_.surroundings.density(direction));
}

/// A ray that brings all of the light sees its mean over the cone: a sun's disc in a curved mirror would be noise. What
/// is shared must be the same light from both sides.
double Shader::environment_blur(const Cone& cone, double density) const {
    return context_.samples_environment() && density == 0 ? context_.surroundings.blur_of(cone.spread) : 0;
}

Shader::BothSides Shader::scattered(const Lit& at) {
    const Optics& m = at.surface.optics;
    const double diffuse = (1 - m.metallic) * (1 - m.transmission) / pi,
                 below = diffuse * at.seen.scattered * at.seen.sheen * (1 - at.seen.coat);
    return {below * (1 - m.behind) * m.base_color, below * m.behind * m.behind_color};
}

/// Share of light from a direction that no ray of the path brings: what is scattered, times the cosine.
glm::dvec3 Shader::scattered_from(const Lit& at, const glm::dvec3& direction) {
    const Surface& s = at.surface;
    const Optics& m = s.optics;
    const double n_l = glm::dot(s.normal, direction);
    const auto [front, back] = scattered(at);
    if (n_l <= 0) return back * -n_l;
    glm::dvec3 share = front * n_l;
    if (largest(m.sheen) > 0) {
        const double n_h = glm::dot(s.normal, glm::normalize(direction - at.path.direction));
        share += (1 - at.seen.coat) * m.sheen *
                 sheen::lobe(sheen::alpha_of(m.sheen_roughness), n_h, std::max(GRAZING_COSINE, at.seen.n_v), n_l);
    }
    return share;
}

/// Of light from a drawn direction, what the lobes mirror over the density of such directions: the environment's, and
/// that of the lobe's own samples, which bring the rest.
glm::dvec3 Shader::mirrored_from(const Lit& at, const Surroundings::Drawn& drawn) const {
    const Surface& s = at.surface;
    const Optics& m = s.optics;
    if (m.shares_branch() || (m.behind > 0 && glm::dot(s.normal, drawn.direction) < 0)) return glm::dvec3(0);
    const glm::dvec3 view = -at.path.direction;
    const double v_h = std::clamp(glm::dot(view, glm::normalize(view + drawn.direction)), 0.0, 1.0);
    const bool leaving = m.leaves(s.front);
    glm::dvec3 sum(0);
    if (const double density = lobe_of(s).density(view, drawn.direction); density > 0) {
        const Parts fresnel{m.wall_reflectance(v_h, leaving, Channel::green),
                            m.metal_reflectance(v_h, leaving, Channel::green)};
        sum = specular(s, at.path, fresnel, at.seen.n_v, drawn.direction) * at.seen.sheen * (1 - at.seen.coat) /
              (drawn.density + density);
    }
    if (m.clearcoat == 0) return sum;
    const Lobe coat = coat_lobe(s);
    const double density = coat.density(view, drawn.direction);
    return sum + coat_reflectance(m, v_h) * density * coat.masking(drawn.direction) / (drawn.density + density);
}

/// One direction per hit: half of them by the environment's brightness, half by the cosine where the surface scatters
/// light at all.
glm::dvec3 Shader::environment_light(const Lit& at) {
    const Surface& s = at.surface;
    const Optics& m = s.optics;
    const bool diffuse = m.metallic < 1 && m.transmission < 1, scatters = diffuse || largest(m.sheen) > 0;
    const double by_brightness = scatters ? 0.5 : 1, behind = diffuse ? m.behind : 0;
    glm::dvec2 u = random(at.path, RANDOM_ENVIRONMENT);
    const bool bright = u.x < by_brightness;
    u.x = bright ? u.x / by_brightness : (u.x - by_brightness) / (1 - by_brightness);
    Surroundings::Drawn drawn{};
    if (bright) {
        drawn = context_.surroundings.draw(u);
    } else {
        const bool back = u.x < behind;
        u.x = back ? u.x / behind : (u.x - behind) / (1 - behind);
        drawn.direction = cosine_direction(s.normal, u) * (back ? -1.0 : 1.0);
        drawn.density = context_.surroundings.density(drawn.direction);
    }
    const double n_l = glm::dot(s.normal, drawn.direction);
    const double around_normal = (n_l > 0 ? 1 - behind : behind) * std::abs(n_l) / pi;
    const double mixed = by_brightness * drawn.density + (1 - by_brightness) * around_normal;
    glm::dvec3 share(0);
    if (scatters && mixed > 0) share = scattered_from(at, drawn.direction) / mixed;
    if (bright) share += mirrored_from(at, drawn) / by_brightness;
    if (share == glm::dvec3(0)) return share;
    const glm::dvec3 light = share * context_.surroundings.radiance(drawn.direction, 0);
    return light == glm::dvec3(0) ? light : light * arriving(at, drawn.direction, nullptr);
}

}  // namespace peelray
