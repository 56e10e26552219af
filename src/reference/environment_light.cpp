// The environment's light on what is no mirror, by rays in directions drawn by its brightness and by the surface's
// lobes (docs/frame.md section 5).
#include <algorithm>
#include <cmath>

#include "reference/shader.h"
#include "reference/sheen.h"

namespace peelray::inline PRECISION {

using namespace optics;

/// What of the environment's light comes along a ray; the rest its hit has found by drawing directions to the
/// environment (Veach and Guibas, Optimally Combining Sampling Techniques, 1995: the balance heuristic).
real Shader::environment_share(const Vec2& place, real density) const {
    if (density == 0 || context_.settings.env_mode == EnvironmentMode::open) return 1;
    return density < 0 ? 0 : density / (density + context_.surroundings.density_at(place));
}

/// A ray that brings all of the light sees its mean over the cone: a sun's disc in a curved mirror would be noise. What
/// is shared must be the same light from both sides.
real Shader::environment_blur(const Cone& cone, real density) const {
    if (context_.settings.env_mode == EnvironmentMode::open || density != 0) return 0;
    // All of a pixel's cone, not a sample's share of it: a sun that fills a part of it is seen by that part.
    return context_.surroundings.blur_of(cone.spread * std::sqrt(real(context_.settings.spp)));
}

Shader::BothSides Shader::scattered(const Lit& at) {
    const Optics& m = at.surface.optics;
    const real diffuse = (1 - m.metallic) * (1 - m.transmission) / pi,
               below = diffuse * at.seen.scattered * at.seen.sheen * (1 - at.seen.coat);
    return {below * (1 - m.behind) * m.base_color, below * m.behind * m.behind_color};
}

/// Share of light from a direction that no ray of the path brings: what is scattered, times the cosine.
Vec3 Shader::scattered_from(const Lit& at, const Vec3& direction) {
    const Surface& s = at.surface;
    const Optics& m = s.optics;
    const real n_l = glm::dot(s.normal, direction);
    const auto [front, back] = scattered(at);
    if (n_l <= 0) return back * -n_l;
    Vec3 share = front * n_l;
    if (largest(m.sheen) > 0) {
        const real n_h = glm::dot(s.normal, glm::normalize(direction - at.path.direction));
        share += (1 - at.seen.coat) * m.sheen *
                 sheen::lobe(sheen::alpha_of(m.sheen_roughness), n_h, std::max(GRAZING_COSINE, at.seen.n_v), n_l);
    }
    return share;
}

/// Of light from a drawn direction, what the lobes mirror over the density of such directions: the light's, and that of
/// the lobe's own samples, which bring the rest if they are followed.
Vec3 Shader::mirrored_from(const Lit& at, const Vec3& direction, real drawn_density, bool followed) const {
    const Surface& s = at.surface;
    const Optics& m = s.optics;
    const bool through = m.behind > 0 && glm::dot(s.normal, direction) < 0;
    if (!context_.sampled() || m.shares_branch() || through) return Vec3(0);
    const Vec3 view = -at.path.direction;
    const real v_h = std::clamp(glm::dot(view, glm::normalize(view + direction)), 0.0, 1.0);
    const bool leaving = m.leaves(s.front);
    Vec3 sum(0);
    const Lobe lobe = lobe_of(s);
    if (const real density = lobe.density(view, direction); density > 0) {
        const Parts fresnel{m.wall_reflectance(v_h, leaving, Channel::green),
                            m.metal_reflectance(v_h, leaving, Channel::green)};
        const real traced = !followed ? 0 : m.transmits() ? 1 : traced_part(m.lobe_roughness(), m.metallic);
        sum = specular(s, at.path, lobe, density, fresnel, at.seen.n_v, direction) * at.seen.sheen *
              (1 - at.seen.coat) / (drawn_density + traced * density);
    }
    if (m.clearcoat == 0) return sum;
    const Lobe coat = coat_lobe(s);
    const real density = coat.density(view, direction), traced = followed ? traced_part(m.coat_roughness, 0) : 0;
    return sum + coat_reflectance(m, v_h) * density * coat.masking(direction) / (drawn_density + traced * density);
}

/// Is there a lobe that mirrors light from directions that are drawn? A mirror has one direction.
bool Shader::mirrors_drawn(const Optics& m) {
    return m.lobe_roughness() >= MIRROR_ROUGHNESS || (m.clearcoat > 0 && m.coat_roughness >= MIRROR_ROUGHNESS);
}

bool Shader::scatters(const Optics& m) {
    return (m.metallic < 1 && m.transmission < 1) || largest(m.sheen) > 0;
}

/// Share of the directions around the normal that go behind the surface.
static real share_behind(const Optics& m) {
    return m.metallic < 1 && m.transmission < 1 ? m.behind : 0;
}

Vec3 Shader::draw_scattered(const Lit& at, Vec2 random) {
    const real behind = share_behind(at.surface.optics);
    const bool back = random.x < behind;
    random.x = back ? random.x / behind : (random.x - behind) / (1 - behind);
    return cosine_direction(at.surface.normal, random) * (back ? -1.0 : 1.0);
}

/// Of the directions that draw_scattered() returns.
real Shader::scattered_density(const Lit& at, const Vec3& direction) {
    const real n_l = glm::dot(at.surface.normal, direction), behind = share_behind(at.surface.optics);
    return (n_l > 0 ? 1 - behind : behind) * std::abs(n_l) / pi;
}

/// One direction per hit: half of them by the environment's brightness, half by the cosine where the surface scatters
/// light at all.
Vec3 Shader::environment_light(const Lit& at) {
    const bool scattering = scatters(at.surface.optics);
    if (!scattering && !mirrors_drawn(at.surface.optics)) return Vec3(0);
    const real by_brightness = scattering ? 0.5 : 1;
    Vec2 u = random(at.path, RANDOM_ENVIRONMENT);
    const bool bright = u.x < by_brightness;
    u.x = bright ? u.x / by_brightness : (u.x - by_brightness) / (1 - by_brightness);
    Surroundings::Drawn drawn{};
    if (bright) {
        drawn = context_.surroundings.draw(u);
        context_.surroundings.prefetch(drawn.place, false);
    } else {
        drawn.direction = draw_scattered(at, u);
        drawn.place = Surroundings::place(drawn.direction);
        context_.surroundings.prefetch(drawn.place, false);
        drawn.density = context_.surroundings.density_at(drawn.place);
    }
    const real mixed = by_brightness * drawn.density + (1 - by_brightness) * scattered_density(at, drawn.direction);
    Vec3 share(0);
    if (scattering && mixed > 0) share = scattered_from(at, drawn.direction) / mixed;
    if (bright) share += mirrored_from(at, drawn.direction, drawn.density, true) / by_brightness;
    if (share == Vec3(0)) return share;
    const Vec3 light = share * context_.surroundings.radiance_at(drawn.place, 0);
    if (light == Vec3(0)) return light;
    // What the camera sees itself would get noisy: dark surfaces by a tenth, all others by nothing.
    const bool for_certain = at.path.level == 0;
    const real kept = for_certain ? 1
                                  : roulette(largest(light * at.path.weight) / context_.surroundings.usual(), at.path,
                                             RANDOM_ENVIRONMENT_ROULETTE);
    if (kept == 0) return Vec3(0);
    return light / kept * arriving(at, start_to(at, drawn.direction), drawn.direction, endless);
}

/// What light other surfaces send to this one to be scattered: one ray stands for all of it.
Shader::Branch Shader::diffuse_branch(const Lit& at) const {
    const Surface& s = at.surface;
    Branch branch;
    if (at.path.scattered >= context_.settings.gi || !scatters(s.optics)) return branch;
    const Vec3 direction = draw_scattered(at, random(at.path, RANDOM_DIFFUSE));
    const real density = scattered_density(at, direction);
    if (density == 0) return branch;
    const bool back = glm::dot(s.normal, direction) < 0;
    branch.weight = s.optics.alpha * scattered_from(at, direction) / density;
    branch.direction = above_surface(direction, back ? -s.geometric : s.geometric);
    branch.media = back ? at.behind : at.path.media;
    branch.cone = {at.path.cone.width, 1};  // blurred as it is, it may show textures as coarse as that
    branch.density = -1;
    branch.traced = largest(branch.weight * at.path.weight) >= LEAST_WEIGHT && at.path.level < context_.last_level;
    return branch;
}

}  // namespace peelray::inline PRECISION
