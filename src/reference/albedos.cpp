#include "reference/albedos.h"

#include <algorithm>
#include <cmath>

#include "reference/optics.h"
#include "reference/sheen.h"

namespace peelray::inline PRECISION {
namespace {

/// Of GGX by quadrature over its microfacets: D·G1(v)·G1(l)·F·(v·h)/(v.z), in rings that follow D·h.z and
/// crowd where the microfacets are steep: equal shares of them err by up to 0.05 at grazing angles.
Albedos::Means integrate(const Optics& m, real cosine) {
    constexpr int rings = is_reference ? 128 : 96, sectors = is_reference ? 64 : 16;  // 10⁻³ with a third of 96
    const real alpha = m.roughness * m.roughness, a2 = alpha * alpha, sine = std::sqrt(1 - cosine * cosine);
    Albedos::Means sum;
    for (int i = 0; i < rings; i++) {
        const real t = (i + 0.5) / rings, u = 1 - t * t, up2 = (1 - u) / (1 + (a2 - 1) * u), up = std::sqrt(up2);
        const real across = std::sqrt(1 - up2);
        for (int k = 0; k < sectors; k++) {
            const real v_h = sine * across * std::cos(optics::pi * (k + 0.5) / sectors) + cosine * up;
            const real n_l = 2 * v_h * up - cosine;
            if (v_h <= 0 || n_l <= 0) continue;
            const real share = optics::ggx_masking(cosine, alpha) * optics::ggx_masking(n_l, alpha) * v_h * 2 * t /
                               (cosine * up * rings * sectors);
            const real facing = std::min(v_h, 1.0), grazing = optics::fresnel_schlick(Vec3(0), 1, facing).x;
            sum.dielectric += share * m.face_reflectance(facing, false);
            sum.normal += share * (1 - grazing);
            sum.grazing += share * grazing;
        }
    }
    return sum;
}

Albedos::Means mixed(const Albedos::Means& a, const Albedos::Means& b, real part) {
    return {glm::mix(a.dielectric, b.dielectric, part), glm::mix(a.normal, b.normal, part),
            glm::mix(a.grazing, b.grazing, part)};
}

}  // namespace

Albedos::Albedos(const Scene& scene, const Surfaces& surfaces) : surfaces_(surfaces), first_table_{0}, first_sheen_{0} {
    for (const Material& m : scene.materials) {
        first_table_.push_back(first_table_.back() + (m.roughness_texture || m.anisotropy > 0 ? roughnesses : 1));
        first_sheen_.push_back(first_sheen_.back() + (m.sheen_roughness_texture ? roughnesses : 1));
    }
    sheens_ = std::make_unique<SheenTable[]>(first_sheen_.back());
    tables_ = std::make_unique<Table[]>(first_table_.back());
    coats_ = std::make_unique<Table[]>(roughnesses);
}

Albedos::Means Albedos::look_up(Table& table, const Optics& constants, real roughness, real cosine) const {
    std::call_once(table.made, [&] {
        Optics m = constants;
        m.roughness = roughness;
        m.film = m.spread = 0;
        for (size_t i = 0; i <= steps; i++)
            table.entries[i] = integrate(m, std::max(GRAZING_COSINE, square(real(i) / steps)));
    });
    const real place = std::sqrt(std::clamp(cosine, 0.0, 1.0)) * steps;
    const size_t lower = std::min(size_t(place), steps - 1);
    return mixed(table.entries[lower], table.entries[lower + 1], place - real(lower));
}

Albedos::Means Albedos::between(Table* first, const Optics& constants, real roughness, real cosine) const {
    constexpr real last = roughnesses - 1;
    const real place = std::sqrt(std::clamp(roughness, 0.0, 1.0)) * last;
    const size_t lower = std::min(size_t(place), roughnesses - 2);
    // A mirror's lobe has no width to integrate over.
    const auto table = [&](size_t i) {
        return look_up(first[i], constants, std::max(square(real(i) / last), 0.5 * MIRROR_ROUGHNESS), cosine);
    };
    return mixed(table(lower), table(lower + 1), place - real(lower));
}

Albedos::Means Albedos::at(const Surface& surface, real cosine) const {
    if (cosine == surface.means_cosine) return surface.means;
    const Optics &constants = surfaces_.optics(surface.material), &here = surface.optics;
    Table* first = &tables_[first_table_[surface.material]];
    const bool varies = first_table_[surface.material + 1] > first_table_[surface.material] + 1;
    Means means = varies ? between(first, constants, surface.mean_roughness, cosine)
                         : look_up(*first, constants, constants.roughness, cosine);
    // Schlick's is linear in both reflectances, which textures change.
    if (here.specified) means.dielectric = here.f0 * means.normal + here.f90 * means.grazing;
    surface.means = means;
    surface.means_cosine = cosine;
    return means;
}

real Albedos::coat(const Surface& surface, real cosine) const {
    const Optics& m = surface.optics;
    if (m.clearcoat == 0) return 0;
    cosine = std::clamp(cosine, 0.0, 1.0);
    if (m.coat_roughness < MIRROR_ROUGHNESS)
        return m.clearcoat * optics::fresnel_schlick(Vec3(COAT_REFLECTANCE), 1, cosine).x;
    const Means means = between(coats_.get(), Optics(), m.coat_roughness, cosine);
    return m.clearcoat * (COAT_REFLECTANCE * means.normal + means.grazing);
}

real Albedos::look_up(SheenTable& table, real alpha, real cosine) {
    constexpr size_t steps = SheenTable::steps;
    std::call_once(table.made, [&] {
        for (size_t i = 0; i <= steps; i++)
            table.entries[i] = sheen::albedo(alpha, std::max(GRAZING_COSINE, square(real(i) / steps)));
    });
    const real place = std::sqrt(std::clamp(cosine, 0.0, 1.0)) * steps;
    const size_t lower = std::min(size_t(place), steps - 1);
    return glm::mix(table.entries[lower], table.entries[lower + 1], place - real(lower));
}

real Albedos::sheen(const Surface& surface, real cosine) const {
    SheenTable* first = &sheens_[first_sheen_[surface.material]];
    const real roughness = std::max(surface.optics.sheen_roughness, SHEEN_LEAST_ROUGHNESS);
    const bool varies = first_sheen_[surface.material + 1] > first_sheen_[surface.material] + 1;
    if (!varies) return look_up(*first, sheen::alpha_of(roughness), cosine);
    constexpr real last = roughnesses - 1;
    const real place = (roughness - SHEEN_LEAST_ROUGHNESS) / (1 - SHEEN_LEAST_ROUGHNESS) * last;
    const size_t lower = std::min(size_t(place), roughnesses - 2);
    const auto table = [&](size_t i) {
        const real of = glm::mix(SHEEN_LEAST_ROUGHNESS, 1.0, real(i) / last);
        return look_up(first[i], sheen::alpha_of(of), cosine);
    };
    return glm::mix(table(lower), table(lower + 1), place - real(lower));
}

}  // namespace peelray::inline PRECISION
