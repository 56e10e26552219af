// Light of emissive triangles on other surfaces (docs/frame.md section 5).
#include <cmath>

#include "reference/shader.h"

namespace peelray::inline PRECISION {

using namespace optics;

/// Of light being looked for where a ray meets the triangle, per steradian.
real Shader::emitter_density(uint32_t triangle, real probability, const Vec3& direction, real distance) const {
    const auto [a, b, c] = context_.surfaces.corners(triangle);
    const real projected = std::abs(glm::dot(glm::cross(b - a, c - a), direction));  // twice the area's
    return projected > 0 ? 2 * probability * distance * distance / projected : 0;
}

/// What of the emission that a ray meets it is to bring; the rest is found by looking for it. Images of emitters on
/// surfaces that scatter, by mirrors and glass, are left out: few rays would find them.
real Shader::emission_share(const Path& path, const Hit& hit) const {
    if (!context_.samples_emitters() || (path.density == 0 && path.scattered == 0)) return 1;
    const real probability = context_.emitters.probability(hit.triangle);
    if (probability == 0) return 1;
    if (path.density <= 0) return 0;
    return path.density / (path.density + emitter_density(hit.triangle, probability, path.direction, hit.t));
}

/// What a point of a triangle sends against a direction.
Vec3 Shader::emission_towards(uint32_t triangle, real u, real v, const Vec3& direction) const {
    if (const auto plain = context_.surfaces.plain_emission(triangle, u, v)) {
        const auto [a, b, c] = context_.surfaces.corners(triangle);
        const bool front = glm::dot(glm::cross(b - a, c - a), direction) < 0;
        return front || !context_.triangles.is_single(triangle) ? *plain : Vec3(0);
    }
    const Surface lamp = context_.surfaces.at(triangle, u, v, direction);
    if (!lamp.front && context_.triangles.is_single(triangle)) return Vec3(0);
    const real coat = context_.albedos.coat(lamp, -glm::dot(direction, lamp.coat_normal));
    return lamp.optics.emissive * lamp.optics.alpha * (1 - coat);
}

/// From one point of one triangle.
Vec3 Shader::emitter_light(const Lit& at) {
    if (!scatters(at.surface.optics) && !mirrors_drawn(at.surface.optics)) return Vec3(0);
    const Emitter& emitter = context_.emitters.choose(random(at.path, RANDOM_EMITTER).x);
    if (emitter.id == at.triangle) return Vec3(0);
    const Vec2 r = random(at.path, RANDOM_EMITTER_POINT);
    const real root = std::sqrt(r.x), u = root * (1 - r.y), v = root * r.y;
    const auto [a, b, c] = context_.surfaces.corners(emitter.id);
    const Vec3 way = a + (b - a) * u + (c - a) * v - at.surface.position;
    const real distance = glm::length(way);
    if (distance == 0) return Vec3(0);
    const Vec3 direction = way / distance;
    const real density = emitter_density(emitter.id, real(emitter.probability), direction, distance);
    if (density == 0) return Vec3(0);
    const bool followed = context_.settings.reflection && !is_last(at.path, false);
    const Vec3 share = scattered_from(at, direction) / density + mirrored_from(at, direction, density, followed);
    if (share == Vec3(0) || !context_.triangles.is_present(emitter.id, u, v)) return Vec3(0);
    const Vec3 most = share * at.path.weight * context_.surfaces.optics_of_triangle(emitter.id).emissive;
    const real kept = roulette(largest(most) / context_.surroundings.usual(), at.path, RANDOM_EMITTER_ROULETTE);
    if (kept == 0) return Vec3(0);
    const Vec3 light = share * emission_towards(emitter.id, u, v, direction) / kept;
    if (light == Vec3(0)) return light;
    return light * arriving(at, start_to(at, direction), direction, distance * (1 - EMITTER_GAP));
}

}  // namespace peelray::inline PRECISION
