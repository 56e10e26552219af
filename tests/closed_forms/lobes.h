// Lobes of cloth and of brushed surfaces, by their papers.
#pragma once

#include <scenes.h>

namespace peelray {

/// Estevez and Kulla's lobe without its cosine, by the rows of their table.
inline double fibres(double roughness, const glm::dvec3& view, const glm::dvec3& to_light) {
    const double alpha = std::pow(std::max(roughness, 0.07), 2), t = std::pow(1 - alpha, 2);
    const auto mixed = [&](double smooth, double rough) { return rough + (smooth - rough) * t; };
    const double a = mixed(25.3245, 21.5473), b = mixed(3.32435, 3.82987), c = mixed(0.16801, 0.19823),
                 d = mixed(-1.27393, -1.97760), e = mixed(-4.85967, -4.32054);
    const auto l = [&](double x) { return a / (1 + b * std::pow(x, c)) + d * x + e; };
    const auto lambda = [&](double x) { return std::exp(x < 0.5 ? l(x) : 2 * l(0.5) - l(1 - x)); };
    const glm::dvec3 half = glm::normalize(view + to_light);
    const double sine = std::hypot(half.x, half.y);
    return (2 + 1 / alpha) * std::pow(sine, 1 / alpha) / (2 * kPi) /
           ((1 + lambda(view.z) + lambda(to_light.z)) * 4 * view.z * to_light.z);
}

/// Of light from everywhere: by the angle to the normal and around it.
inline double fibre_albedo(double roughness, double cosine) {
    const int rings = 300, sectors = 60;
    double sum = 0;
    for (int i = 0; i < rings; i++) {
        const double angle = (i + 0.5) / rings * kPi / 2;
        for (int k = 0; k < sectors; k++) {
            const double around = (k + 0.5) / sectors * kPi;
            const glm::dvec3 l(std::sin(angle) * std::cos(around), std::sin(angle) * std::sin(around), std::cos(angle));
            sum += fibres(roughness, to_slanted(cosine), l) * l.z * std::sin(angle);
        }
    }
    return std::min(1.0, sum * kPi * kPi / (rings * sectors));
}

/// texture_square() with tangents along x, so that the bitangent is y.
inline Primitive brushed_square() {
    Primitive square = texture_square();
    square.tangents.assign(4, {1, 0, 0, 1});
    return square;
}

/// GGX with two widths (Heitz, JCGT 2014); directions in the frame of the surface, in which the lobe is turned.
struct TwoWidths {
    double along, across, rotation;

    TwoWidths(double roughness, double anisotropy, double rotation) : rotation(rotation) {
        across = std::max(roughness * roughness, 0.0025);
        along = across + (1 - across) * anisotropy * anisotropy;
    }
    TwoWidths(const TwoWidths& widths, double rotation)
        : along(widths.along), across(widths.across), rotation(rotation) {}
    glm::dvec3 turned(const glm::dvec3& d) const {
        const double c = std::cos(rotation), s = std::sin(rotation);
        return {c * d.x + s * d.y, c * d.y - s * d.x, d.z};
    }
    /// Of the round lobe that masks this view as much.
    double mean_roughness(const glm::dvec3& view) const {
        const glm::dvec3 v = turned(view);
        const double wide2 = std::pow(along * v.x, 2) + std::pow(across * v.y, 2);
        return std::pow(wide2 / (v.x * v.x + v.y * v.y), 0.25);
    }
    double masking(const glm::dvec3& direction) const {
        const glm::dvec3 d = turned(direction);
        const double slope2 = (std::pow(along * d.x, 2) + std::pow(across * d.y, 2)) / (d.z * d.z);
        return 2 / (1 + std::sqrt(1 + slope2));
    }
    /// Times the cosine, without Fresnel.
    double lobe(const glm::dvec3& view, const glm::dvec3& to_light) const {
        const glm::dvec3 h = turned(glm::normalize(view + to_light));
        const double k = std::pow(h.x / along, 2) + std::pow(h.y / across, 2) + h.z * h.z;
        return masking(view) * masking(to_light) / (4 * view.z * kPi * along * across * k * k);
    }
    /// What is reflected of light from everywhere, by microfacets of equal shares of D·(n·h).
    double kept(const glm::dvec3& view) const {
        const TwoWidths straight(*this, 0);
        const int rings = 150, sectors = 120;
        double sum = 0;
        for (int i = 0; i < rings; i++) {
            const double t = (i + 0.5) / rings, u = 1 - t * t, r = std::sqrt(u / (1 - u));
            for (int k = 0; k < sectors; k++) {
                const double a = (k + 0.5) / sectors * 2 * kPi;
                const glm::dvec3 local =
                    glm::normalize(glm::dvec3(r * along * std::cos(a), r * across * std::sin(a), 1));
                const glm::dvec3 v = turned(view), l = 2 * glm::dot(v, local) * local - v;
                if (glm::dot(v, local) <= 0 || l.z <= 0) continue;
                sum += 2 * t * straight.masking(v) * straight.masking(l) * glm::dot(v, local) / (local.z * v.z);
            }
        }
        return sum / (rings * sectors);
    }
};

}  // namespace peelray
