#include "reference/ray_triangle.h"

#include <algorithm>
#include <cmath>

namespace peelray {
namespace {

bool finite(const glm::dvec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// Products of differences of floats are exact or nearly so in double; two collinear edges give exactly zero.
bool has_area(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    return glm::cross(b - a, c - a) != glm::dvec3(0);
}

}  // namespace

TriangleSet::TriangleSet(const Geometry& geometry) {
    lower = glm::dvec3(std::numeric_limits<double>::infinity());
    upper = -lower;
    const size_t count = geometry.positions.size();
    for (size_t i = 0; i < geometry.triangles.size(); ++i) {
        const glm::uvec3 t = geometry.triangles[i];
        if (t.x >= count || t.y >= count || t.z >= count) continue;
        const std::array<glm::vec3, 3> c = {geometry.positions[t.x], geometry.positions[t.y], geometry.positions[t.z]};
        if (!finite(c[0]) || !finite(c[1]) || !finite(c[2])) continue;
        for (const glm::vec3& corner : c) {
            lower = glm::min(lower, glm::dvec3(corner));
            upper = glm::max(upper, glm::dvec3(corner));
        }
        if (!has_area(c[0], c[1], c[2])) continue;
        corners.push_back(c);
        ids.push_back(uint32_t(i));
    }
    if (lower.x > upper.x) lower = upper = glm::dvec3(0);
    diagonal = glm::length(upper - lower);
}

std::pair<double, double> clip(const glm::dvec3& origin, const glm::dvec3& direction, const glm::dvec3& lower,
                               const glm::dvec3& upper) {
    double first = -std::numeric_limits<double>::infinity(), last = -first;
    for (int i = 0; i < 3; ++i) {
        if (direction[i] == 0) {
            if (origin[i] < lower[i] || origin[i] > upper[i]) return {1, 0};
            continue;
        }
        const double a = (lower[i] - origin[i]) / direction[i], b = (upper[i] - origin[i]) / direction[i];
        first = std::max(first, std::min(a, b));
        last = std::min(last, std::max(a, b));
    }
    return {first, last};
}

std::optional<PreparedRay> PreparedRay::make(const OracleRay& ray, const TriangleSet& scene) {
    if (!finite(ray.origin) || !finite(ray.direction) || !(ray.tmin < ray.tmax)) return {};
    const glm::dvec3 size = glm::abs(ray.direction);
    const double largest = std::max({size.x, size.y, size.z});
    if (largest == 0) return {};
    PreparedRay r;
    r.tmin = ray.tmin;
    r.tmax = ray.tmax;
    (void)std::frexp(largest, &r.exponent);
    for (int i = 0; i < 3; ++i) r.direction[i] = std::ldexp(ray.direction[i], -r.exponent);
    r.origin = ray.origin;
    const glm::dvec3 center = (scene.lower + scene.upper) * 0.5;
    const double along = glm::dot(center - ray.origin, r.direction) / glm::dot(r.direction, r.direction);
    // fma: the moved origin is the exact point of the ray at `along`, rounded once.
    if (std::abs(along) > 2 * scene.diagonal && std::isfinite(along)) {
        r.start = along;
        for (int i = 0; i < 3; ++i) r.origin[i] = std::fma(along, r.direction[i], ray.origin[i]);
    }
    r.kz_ = size.x == largest ? 0 : size.y == largest ? 1 : 2;
    r.kx_ = (r.kz_ + 1) % 3;
    r.ky_ = (r.kz_ + 2) % 3;
    r.sz_ = 1 / r.direction[r.kz_];
    r.sx_ = r.direction[r.kx_] * r.sz_;
    r.sy_ = r.direction[r.ky_] * r.sz_;
    return r;
}

glm::dvec3 PreparedRay::sheared(const glm::vec3& vertex) const {
    const glm::dvec3 p = glm::dvec3(vertex) - origin;
    return {p[kx_] - sx_ * p[kz_], p[ky_] - sy_ * p[kz_], sz_ * p[kz_]};
}

bool PreparedRay::intersect(const std::array<glm::vec3, 3>& corners, OracleHit& hit) const {
    const glm::dvec3 a = sheared(corners[0]), b = sheared(corners[1]), c = sheared(corners[2]);
    const double u = c.x * b.y - c.y * b.x, v = a.x * c.y - a.y * c.x, w = b.x * a.y - b.y * a.x;
    if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)) return false;
    const double sum = u + v + w;
    if (sum == 0 || !std::isfinite(sum)) return false;  // edge-on: the neighbours that face the ray have the edge
    const double weight_a = u / sum, weight_b = v / sum, weight_c = w / sum;
    const double z = weight_a * a.z + weight_b * b.z + weight_c * c.z;
    const double t = std::ldexp(start + z, -exponent);
    if (!(t > tmin && t < tmax)) return false;
    hit.t = t;
    hit.u = weight_b;
    hit.v = weight_c;
    return true;
}

}  // namespace peelray
