#include "reference/albedos.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "reference/optics.h"
#include "reference/sheen.h"

namespace peelray::inline PRECISION {
namespace {

/// Of GGX by quadrature over its microfacets: D·G1(v)·G1(l)·F·(v·h)/(v.z), in rings that follow D·h.z and
/// crowd where the microfacets are steep: equal shares of them err by up to 0.05 at grazing angles.
Albedos::Grays integrate(real ior, real roughness, real cosine) {
    constexpr int rings = is_reference ? 128 : 96, sectors = is_reference ? 64 : 16;  // 10⁻³ with a third of 96
    static const std::array<real, sectors> around = [] {
        std::array<real, sectors> around;
        for (int k = 0; k < sectors; k++) around[size_t(k)] = std::cos(optics::pi * (k + 0.5) / sectors);
        return around;
    }();
    const real alpha = roughness * roughness, a2 = alpha * alpha, sine = std::sqrt(1 - cosine * cosine);
    const real masked = optics::ggx_masking(cosine, alpha);
    // Sector by sector and without a branch: vectors of them, at a quarter of the time.
    std::array<real, sectors> dielectric{}, normal{}, grazing{};
    for (int i = 0; i < rings; i++) {
        const real t = (i + 0.5) / rings, u = 1 - t * t, up2 = (1 - u) / (1 + (a2 - 1) * u), up = std::sqrt(up2);
        const real across = std::sqrt(1 - up2), of_ring = masked * 2 * t / (cosine * up * rings * sectors);
        for (size_t k = 0; k < sectors; k++) {
            const real v_h = sine * across * around[k] + cosine * up, n_l = 2 * v_h * up - cosine;
            const real share = v_h > 0 && n_l > 0 ? of_ring * v_h * optics::ggx_masking(std::abs(n_l), alpha) : 0;
            // Above 0, where an index of 1 would leave nothing over nothing.
            const real facing = std::clamp(v_h, 1e-30, 1.0), x = 1 - facing, far = square(square(x)) * x;
            // No total reflection on the way in.
            const real inside = std::sqrt(std::max(0.0, 1 - (1 - facing * facing) / (ior * ior)));
            const real s = (facing - ior * inside) / (facing + ior * inside),
                       p = (ior * facing - inside) / (ior * facing + inside);
            dielectric[k] += share * (s * s + p * p) / 2;
            normal[k] += share * (1 - far);
            grazing[k] += share * far;
        }
    }
    Albedos::Grays sum;
    for (size_t k = 0; k < sectors; k++) {
        sum.dielectric += dielectric[k];
        sum.normal += normal[k];
        sum.grazing += grazing[k];
    }
    return sum;
}

Albedos::Grays mixed(const Albedos::Grays& a, const Albedos::Grays& b, real part) {
    return {glm::mix(a.dielectric, b.dielectric, part), glm::mix(a.normal, b.normal, part),
            glm::mix(a.grazing, b.grazing, part)};
}

}  // namespace

Albedos::Albedos(const Scene& scene, const Surfaces& surfaces) : surfaces_(surfaces), first_sheen_{0} {
    std::map<std::pair<real, real>, Lobes> made;
    size_t tables = 0;
    for (uint32_t i = 0; i < scene.materials.size(); i++) {
        const Material& m = scene.materials[i];
        const bool varies = m.roughness_texture || m.anisotropy > 0;
        const Optics& constants = surfaces.optics(i);
        const auto [at, is_new] =
            made.try_emplace({constants.ior, varies ? -1 : constants.roughness}, Lobes{tables, varies});
        if (is_new) tables += varies ? roughnesses : 1;
        lobes_.push_back(at->second);
        first_sheen_.push_back(first_sheen_.back() + (m.sheen_roughness_texture ? roughnesses : 1));
    }
    sheens_ = std::make_unique<SheenTable[]>(first_sheen_.back());
    tables_ = std::make_unique<Table[]>(tables);
    coats_ = std::make_unique<Table[]>(roughnesses);
}

/// Where a cosine is between the entries of a table.
struct Albedos::Place {
    size_t lower;
    real part;
    Place(real cosine, size_t steps) {
        const real place = std::sqrt(std::clamp(cosine, 0.0, 1.0)) * steps;
        lower = std::min(size_t(int(place)), steps - 1);
        part = place - real(lower);
    }
};

Albedos::Grays Albedos::look_up(Table& table, real ior, real roughness, const Place& at) {
    table.once([&] {
        for (size_t i = 0; i <= steps; i++)
            table.entries[i] = integrate(ior, roughness, std::max(GRAZING_COSINE, square(real(i) / steps)));
    });
    return mixed(table.entries[at.lower], table.entries[at.lower + 1], at.part);
}

Albedos::Grays Albedos::between(Table* first, real ior, real roughness, const Place& at) {
    constexpr real last = roughnesses - 1;
    const real place = std::sqrt(std::clamp(roughness, 0.0, 1.0)) * last;
    const size_t lower = std::min(size_t(int(place)), roughnesses - 2);
    // A mirror's lobe has no width to integrate over.
    const auto table = [&](size_t i) {
        return look_up(first[i], ior, std::max(square(real(i) / last), 0.5 * MIRROR_ROUGHNESS), at);
    };
    return mixed(table(lower), table(lower + 1), place - real(lower));
}

Albedos::Means Albedos::at(const Surface& surface, real cosine) const {
    if (cosine == surface.means_cosine) return surface.means;
    const Optics &constants = surfaces_.optics(surface.material), &here = surface.optics;
    const Lobes& lobes = lobes_[surface.material];
    Table* const first = &tables_[lobes.first];
    const Place place(cosine, steps);
    const Grays grays = lobes.vary ? between(first, constants.ior, surface.mean_roughness, place)
                                   : look_up(*first, constants.ior, constants.roughness, place);
    Means means{Vec3(grays.dielectric), grays.normal, grays.grazing};
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
    const Grays grays = between(coats_.get(), 1, m.coat_roughness, Place(cosine, steps));
    return m.clearcoat * (COAT_REFLECTANCE * grays.normal + grays.grazing);
}

real Albedos::look_up(SheenTable& table, real alpha, real cosine) {
    constexpr size_t steps = SheenTable::steps;
    table.once([&] {
        for (size_t i = 0; i <= steps; i++)
            table.entries[i] = sheen::albedo(alpha, std::max(GRAZING_COSINE, square(real(i) / steps)));
    });
    const Place at(cosine, steps);
    return glm::mix(table.entries[at.lower], table.entries[at.lower + 1], at.part);
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
