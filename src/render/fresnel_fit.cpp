#include "render/fresnel_fit.h"

#include <cmath>

#include "path/tables.h"

namespace peelray {
namespace {

double reflectance(double cosine, double ior) {
    const double refracted = std::sqrt(1 - (1 - cosine * cosine) / (ior * ior));
    const double parallel = (ior * cosine - refracted) / (ior * cosine + refracted);
    const double perpendicular = (cosine - ior * refracted) / (cosine + ior * refracted);
    return (parallel * parallel + perpendicular * perpendicular) / 2;
}

}  // namespace

glm::vec4 fresnel_fit(double ior) {
    // Least squares. Weighted by the cosine: most microfacets that a view sees face it.
    constexpr int samples = 100;
    glm::dmat4 products(0);
    glm::dvec4 right(0);
    for (int i = 0; i < samples; i++) {
        const double cosine = (i + 0.5) / samples, m = 1 - cosine, weight = cosine + 0.02;
        const glm::dvec4 powers(1, std::pow(m, SPLIT_SUM_FLAT_EXPONENT), std::pow(m, SPLIT_SUM_SCHLICK_EXPONENT),
                                std::pow(m, SPLIT_SUM_STEEP_EXPONENT));
        products += weight * glm::outerProduct(powers, powers);
        right += weight * reflectance(cosine, ior) * powers;
    }
    return glm::vec4(glm::inverse(products) * right);
}

}  // namespace peelray
