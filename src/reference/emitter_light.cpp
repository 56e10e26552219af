// Light of emissive triangles on other surfaces (docs/frame.md section 5).
#include <cmath>

#include "reference/shader.h"

namespace peelray {

using namespace optics;

/// Of light being looked for where a ray meets the triangle, per steradian.
double Shader::emitter_density(uint32_t triangle, double probability, const glm::dvec3& direction,
                               double distance) const {
    const auto [a, b, c] = context_.surfaces.corners(triangle);
    const double projected = std::abs(glm::dot(glm::cross(b - a, c - a), direction));  // twice the area's
    return projected > 0 ? 2 * probability * distance * distance / projected : 0;
}

/// What of the emission that a ray meets it is to bring; the rest is found by looking for it. Images of emitters on
/// surfaces that scatter, by mirrors and glass, are left out: few rays would find them.
double Shader::emission_share(const Path& path, const OracleHit& hit) const {
    if (!context_.samples_emitters() || (path.density == 0 && path.scattered == 0)) return 1;
    const double probability = context_.emitters.probability(hit.triangle);
    if (probability == 0) return 1;
    if (path.density <= 0) return 0;
    return path.density / (path.density + emitter_density(hit.triangle, probability, path.direction, hit.t));
}

/// From one point of one triangle.
glm::dvec3 Shader::emitter_light(const Lit& at) {
    const Emitter& emitter = context_.emitters.choose(random(at.path, RANDOM_EMITTER).x);
    if (emitter.id == at.triangle) return glm::dvec3(0);
    const glm::dvec2 r = random(at.path, RANDOM_EMITTER_POINT);
    const double root = std::sqrt(r.x), u = root * (1 - r.y), v = root * r.y;
    const auto [a, b, c] = context_.surfaces.corners(emitter.id);
    const glm::dvec3 way = a + (b - a) * u + (c - a) * v - at.surface.position;
    const double distance = glm::length(way);
    if (distance == 0) return glm::dvec3(0);
    const glm::dvec3 direction = way / distance;
    const double density = emitter_density(emitter.id, double(emitter.probability), direction, distance);
    if (density == 0) return glm::dvec3(0);
    const bool followed = context_.settings.reflection && !is_last(at.path, false);
    const glm::dvec3 share =
        scattered_from(at, direction) / density + mirrored_from(at, {direction, density}, followed);
    if (share == glm::dvec3(0) || !context_.bvh.alpha.is_present(emitter.id, u, v)) return glm::dvec3(0);
    const Surface lamp = context_.surfaces.at(emitter.id, u, v, direction);
    if (!lamp.front && context_.bvh.sides.is_single(emitter.id)) return glm::dvec3(0);
    const double coat = context_.albedos.coat(lamp, -glm::dot(direction, lamp.coat_normal));
    const glm::dvec3 light = share * lamp.optics.emissive * lamp.optics.alpha * (1 - coat);
    if (light == glm::dvec3(0)) return light;
    return light * arriving(at, start_to(at, direction), direction, distance * (1 - EMITTER_GAP));
}

}  // namespace peelray
