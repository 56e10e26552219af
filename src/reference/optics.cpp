#include "reference/optics.h"

#include <algorithm>
#include <cmath>

namespace peelray::optics {

double fresnel_dielectric(double cosine, double eta) {
    const double sine_behind = std::sqrt(std::max(0.0, 1 - cosine * cosine)) / eta;
    if (sine_behind >= 1) return 1;
    const double cosine_behind = std::sqrt(1 - sine_behind * sine_behind);
    const double s = (cosine - eta * cosine_behind) / (cosine + eta * cosine_behind);
    const double p = (eta * cosine - cosine_behind) / (eta * cosine + cosine_behind);
    return (s * s + p * p) / 2;
}

glm::dvec3 fresnel_schlick(const glm::dvec3& f0, double f90, double cosine) {
    return f0 + (f90 - f0) * std::pow(std::clamp(1 - cosine, 0.0, 1.0), 5);
}

std::optional<glm::dvec3> refract_ray(const glm::dvec3& incoming, const glm::dvec3& normal, double eta) {
    // The part along the surface shrinks by the index; what is left of the unit length goes into the surface.
    const glm::dvec3 along = (incoming - glm::dot(incoming, normal) * normal) / eta;
    const double into2 = 1 - glm::dot(along, along);
    if (into2 < 0) return std::nullopt;
    return glm::normalize(along - std::sqrt(into2) * normal);
}

glm::dvec3 visible_normal(const glm::dvec3& normal, const glm::dvec3& geometric, const glm::dvec3& to_viewer) {
    const double cosine = glm::dot(normal, to_viewer);
    if (cosine >= LEAST_COSINE) return normal;
    const glm::dvec3 bent = normal + to_viewer * (LEAST_COSINE - cosine);
    return glm::dot(bent, bent) > 1e-12 ? glm::normalize(bent) : geometric;
}

glm::dvec3 above_surface(const glm::dvec3& direction, const glm::dvec3& geometric) {
    const double height = glm::dot(direction, geometric);
    return height >= LEAST_COSINE ? direction : glm::normalize(direction + geometric * (LEAST_COSINE - height));
}

double ggx_distribution(double n_h, double alpha) {
    const double a2 = alpha * alpha, k = n_h * n_h * (a2 - 1) + 1;
    return a2 / (pi * k * k);
}

double ggx_masking(double cosine, double alpha) {
    const double a2 = alpha * alpha;
    return 2 * cosine / (cosine + std::sqrt(a2 + (1 - a2) * cosine * cosine));
}

glm::dvec3 sample_ggx(const glm::dvec3& view, const glm::dvec2& alpha, const glm::dvec2& random) {
    // The hemisphere's visible disc is warped as the stretched view sees it, then unstretched.
    const glm::dvec3 v = glm::normalize(glm::dvec3(alpha.x * view.x, alpha.y * view.y, view.z));
    const double flat = std::hypot(v.x, v.y);
    const glm::dvec3 t1 = flat > 0 ? glm::dvec3(-v.y, v.x, 0) / flat : glm::dvec3(1, 0, 0), t2 = glm::cross(v, t1);
    const double r = std::sqrt(random.x), phi = 2 * pi * random.y, s = (1 + v.z) / 2;
    const double p1 = r * std::cos(phi);
    const double p2 = (1 - s) * std::sqrt(std::max(0.0, 1 - p1 * p1)) + s * r * std::sin(phi);
    const glm::dvec3 n = p1 * t1 + p2 * t2 + std::sqrt(std::max(0.0, 1 - p1 * p1 - p2 * p2)) * v;
    return glm::normalize(glm::dvec3(alpha.x * n.x, alpha.y * n.y, std::max(1e-6, n.z)));
}

Tangents tangents(const glm::dvec3& n) {
    const double s = n.z >= 0 ? 1 : -1, a = -1 / (s + n.z), c = n.x * n.y * a;
    return {{1 + s * n.x * n.x * a, s * c, -s * n.x}, {c, s + n.y * n.y * a, -n.y}};
}

glm::dvec3 cosine_direction(const glm::dvec3& normal, const glm::dvec2& random) {
    const auto [t, b] = tangents(normal);
    const double r = std::sqrt(random.x), phi = 2 * pi * random.y;
    const glm::dvec3 up = normal * std::sqrt(std::max(0.0, 1 - random.x));
    return t * (r * std::cos(phi)) + b * (r * std::sin(phi)) + up;
}

Lobe::Lobe(const glm::dvec3& normal, double alpha) : n(normal), alpha(alpha) {
    const Tangents any = tangents(normal);
    t = any.t;
    b = any.b;
}

Lobe::Lobe(const glm::dvec3& normal, const glm::dvec3& along, const glm::dvec2& alpha)
    : t(along), b(glm::cross(normal, along)), n(normal), alpha(alpha) {}

double Lobe::distribution(const glm::dvec3& half) const {
    const glm::dvec3 h = local(half), stretched(h.x / alpha.x, h.y / alpha.y, h.z);
    const double k = glm::dot(stretched, stretched);
    return 1 / (pi * alpha.x * alpha.y * k * k);
}

double Lobe::masking(const glm::dvec3& direction) const {
    const glm::dvec3 d = local(direction), stretched(d.x * alpha.x, d.y * alpha.y, d.z);
    return d.z > 0 ? 2 * d.z / (d.z + glm::length(stretched)) : 0;
}

double Lobe::density(const glm::dvec3& view, const glm::dvec3& reflected) const {
    if (glm::dot(n, reflected) <= 0 || alpha.x < MIRROR_ROUGHNESS * MIRROR_ROUGHNESS) return 0;
    const double n_v = std::max(GRAZING_COSINE, glm::dot(n, view));
    return distribution(glm::normalize(view + reflected)) * masking(view) / (4 * n_v);
}

glm::dvec3 Lobe::sample(const glm::dvec3& view, const glm::dvec2& random) const {
    const glm::dvec3 v = local(view), above(v.x, v.y, std::max(GRAZING_COSINE, v.z));
    const glm::dvec3 h = sample_ggx(glm::normalize(above), alpha, random);
    return glm::normalize(t * h.x + b * h.y + n * h.z);
}

}  // namespace peelray::optics
