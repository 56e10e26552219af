#include "reference/planar_answer.h"

#include <cmath>
#include <numbers>

namespace peelray {
namespace {

/// Is `holds` true for some parallel ray at most a voxel away?
template <typename Holds>
bool any_beside(const OracleRay& ray, double voxel, Holds holds) {
    const glm::dvec3 d = glm::normalize(ray.direction);
    const glm::dvec3 x = glm::normalize(glm::cross(d, std::abs(d.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0)));
    const glm::dvec3 y = glm::cross(d, x);
    for (const double radius : {0.25, 0.5, 0.75, 1.0})
        for (int i = 0; i < 12; i++) {
            OracleRay moved = ray;
            const double angle = i * std::numbers::pi / 6, r = radius * voxel;
            moved.origin += r * (std::cos(angle) * x + std::sin(angle) * y);
            if (holds(moved)) return true;
        }
    return false;
}

}  // namespace

double distance_off(const Geometry& geometry, const OracleRay& ray, double t, const OracleHit& right) {
    const bool found = std::isfinite(t);
    if (!found || !right.hit()) return found == right.hit() ? 0 : INFINITY;
    const glm::uvec3 corners = geometry.triangles[right.triangle];
    const glm::dvec3 a = geometry.positions[corners.x], b = geometry.positions[corners.y],
                     c = geometry.positions[corners.z];
    const glm::dvec3 normal = glm::normalize(glm::cross(b - a, c - a));
    return std::abs(t - right.t) * std::abs(glm::dot(normal, ray.direction));
}

bool right_beside(const Oracle& oracle, const Geometry& geometry, const OracleRay& ray, double t, double voxel) {
    return any_beside(ray, voxel, [&](const OracleRay& moved) {
        return distance_off(geometry, moved, t, oracle.closest(moved)) <= voxel;
    });
}

bool occluded_beside(const Oracle& oracle, const OracleRay& ray, bool occluded, double voxel) {
    return any_beside(ray, voxel, [&](const OracleRay& moved) { return oracle.closest(moved).hit() == occluded; });
}

}  // namespace peelray
