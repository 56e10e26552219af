#include "reference/albedos.h"

#include <algorithm>
#include <cmath>

#include "reference/optics.h"

namespace peelray {
namespace {

/// Of GGX by quadrature over its microfacets: D·G1(v)·G1(l)·F·(v·h)/(v.z), in rings that follow D·h.z and
/// crowd where the microfacets are steep: equal shares of them err by up to 0.05 at grazing angles.
Albedos::Means integrate(const Optics& m, double cosine) {
    constexpr int rings = 128, sectors = 64;
    const double alpha = m.roughness * m.roughness, a2 = alpha * alpha, sine = std::sqrt(1 - cosine * cosine);
    Albedos::Means sum;
    for (int i = 0; i < rings; i++) {
        const double t = (i + 0.5) / rings, u = 1 - t * t, up2 = (1 - u) / (1 + (a2 - 1) * u), up = std::sqrt(up2);
        const double across = std::sqrt(1 - up2);
        for (int k = 0; k < sectors; k++) {
            const double v_h = sine * across * std::cos(optics::pi * (k + 0.5) / sectors) + cosine * up;
            const double n_l = 2 * v_h * up - cosine;
            if (v_h <= 0 || n_l <= 0) continue;
            const double share = optics::ggx_masking(cosine, alpha) * optics::ggx_masking(n_l, alpha) * v_h * 2 * t /
                                 (cosine * up * rings * sectors);
            const double facing = std::min(v_h, 1.0), grazing = optics::fresnel_schlick(glm::dvec3(0), 1, facing).x;
            sum.dielectric += share * m.face_reflectance(facing, false);
            sum.normal += share * (1 - grazing);
            sum.grazing += share * grazing;
        }
    }
    return sum;
}

}  // namespace

Albedos::Albedos(size_t materials, const Surfaces& surfaces)
    : surfaces_(surfaces), tables_(std::make_unique<Table[]>(materials)) {}

Albedos::Means Albedos::at(uint32_t material, double cosine) const {
    Table& table = tables_[material];
    std::call_once(table.made, [&] {
        for (size_t i = 0; i <= steps; i++)
            table.entries[i] =
                integrate(surfaces_.optics(material), std::max(GRAZING_COSINE, std::pow(double(i) / steps, 2)));
    });
    const double place = std::sqrt(std::clamp(cosine, 0.0, 1.0)) * steps;
    const size_t lower = std::min(size_t(place), steps - 1);
    const Means &a = table.entries[lower], &b = table.entries[lower + 1];
    const double part = place - double(lower);
    return {glm::mix(a.dielectric, b.dielectric, part), glm::mix(a.normal, b.normal, part),
            glm::mix(a.grazing, b.grazing, part)};
}

}  // namespace peelray
