#include "reference/optics.h"

#include <algorithm>
#include <cmath>

namespace peelray::inline PRECISION::optics {

real fresnel_dielectric(real cosine, real eta) {
    const real sine_behind = std::sqrt(std::max(0.0, 1 - cosine * cosine)) / eta;
    if (sine_behind >= 1) return 1;
    const real cosine_behind = std::sqrt(1 - sine_behind * sine_behind);
    const real s = (cosine - eta * cosine_behind) / (cosine + eta * cosine_behind);
    const real p = (eta * cosine - cosine_behind) / (eta * cosine + cosine_behind);
    return (s * s + p * p) / 2;
}

Vec3 fresnel_schlick(const Vec3& f0, real f90, real cosine) {
    const real x = std::clamp(1 - cosine, 0.0, 1.0);
    return f0 + (f90 - f0) * (square(square(x)) * x);
}

std::optional<Vec3> refract_ray(const Vec3& incoming, const Vec3& normal, real eta) {
    // The part along the surface shrinks by the index; what is left of the unit length goes into the surface.
    const Vec3 along = (incoming - glm::dot(incoming, normal) * normal) / eta;
    const real into2 = 1 - glm::dot(along, along);
    if (into2 < 0) return std::nullopt;
    return glm::normalize(along - std::sqrt(into2) * normal);
}

Vec3 visible_normal(const Vec3& normal, const Vec3& geometric, const Vec3& to_viewer) {
    const real cosine = glm::dot(normal, to_viewer);
    if (cosine >= LEAST_COSINE) return normal;
    const Vec3 bent = normal + to_viewer * (LEAST_COSINE - cosine);
    return glm::dot(bent, bent) > 1e-12 ? glm::normalize(bent) : geometric;
}

Vec3 above_surface(const Vec3& direction, const Vec3& geometric) {
    const real height = glm::dot(direction, geometric);
    return height >= LEAST_COSINE ? direction : glm::normalize(direction + geometric * (LEAST_COSINE - height));
}

real ggx_distribution(real n_h, real alpha) {
    const real a2 = alpha * alpha, k = n_h * n_h * (a2 - 1) + 1;
    return a2 / (pi * k * k);
}

real ggx_masking(real cosine, real alpha) {
    const real a2 = alpha * alpha;
    return 2 * cosine / (cosine + std::sqrt(a2 + (1 - a2) * cosine * cosine));
}

Vec3 sample_ggx(const Vec3& view, const Vec2& alpha, const Vec2& random) {
    // The hemisphere's visible disc is warped as the stretched view sees it, then unstretched.
    const Vec3 v = glm::normalize(Vec3(alpha.x * view.x, alpha.y * view.y, view.z));
    const real flat = is_reference ? std::hypot(v.x, v.y) : std::sqrt(v.x * v.x + v.y * v.y);
    const Vec3 t1 = flat > 0 ? Vec3(-v.y, v.x, 0) / flat : Vec3(1, 0, 0), t2 = glm::cross(v, t1);
    const real r = std::sqrt(random.x), phi = 2 * pi * random.y, s = (1 + v.z) / 2;
    const real p1 = r * std::cos(phi);
    const real p2 = (1 - s) * std::sqrt(std::max(0.0, 1 - p1 * p1)) + s * r * std::sin(phi);
    const Vec3 n = p1 * t1 + p2 * t2 + std::sqrt(std::max(0.0, 1 - p1 * p1 - p2 * p2)) * v;
    return glm::normalize(Vec3(alpha.x * n.x, alpha.y * n.y, std::max(1e-6, n.z)));
}

Tangents tangents(const Vec3& n) {
    const real s = n.z >= 0 ? 1 : -1, a = -1 / (s + n.z), c = n.x * n.y * a;
    return {{1 + s * n.x * n.x * a, s * c, -s * n.x}, {c, s + n.y * n.y * a, -n.y}};
}

Vec3 cosine_direction(const Vec3& normal, const Vec2& random) {
    const auto [t, b] = tangents(normal);
    const real r = std::sqrt(random.x), phi = 2 * pi * random.y;
    const Vec3 up = normal * std::sqrt(std::max(0.0, 1 - random.x));
    return t * (r * std::cos(phi)) + b * (r * std::sin(phi)) + up;
}

Lobe::Lobe(const Vec3& normal, real alpha) : n(normal), alpha(alpha) {
    const Tangents any = tangents(normal);
    t = any.t;
    b = any.b;
}

Lobe::Lobe(const Vec3& normal, const Vec3& along, const Vec2& alpha)
    : t(along), b(glm::cross(normal, along)), n(normal), alpha(alpha) {}

real Lobe::distribution(const Vec3& half) const {
    const Vec3 h = local(half), stretched(h.x / alpha.x, h.y / alpha.y, h.z);
    const real k = glm::dot(stretched, stretched);
    return 1 / (pi * alpha.x * alpha.y * k * k);
}

real Lobe::masking(const Vec3& direction) const {
    const Vec3 d = local(direction), stretched(d.x * alpha.x, d.y * alpha.y, d.z);
    return d.z > 0 ? 2 * d.z / (d.z + glm::length(stretched)) : 0;
}

real Lobe::density(const Vec3& view, const Vec3& reflected) const {
    if (glm::dot(n, reflected) <= 0 || alpha.x < MIRROR_ROUGHNESS * MIRROR_ROUGHNESS) return 0;
    const real n_v = std::max(GRAZING_COSINE, glm::dot(n, view));
    return distribution(glm::normalize(view + reflected)) * masking(view) / (4 * n_v);
}

Vec3 Lobe::sample(const Vec3& view, const Vec2& random) const {
    const Vec3 v = local(view), above(v.x, v.y, std::max(GRAZING_COSINE, v.z));
    const Vec3 h = sample_ggx(glm::normalize(above), alpha, random);
    return glm::normalize(t * h.x + b * h.y + n * h.z);
}

}  // namespace peelray::inline PRECISION::optics
