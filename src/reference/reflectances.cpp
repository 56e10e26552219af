// What a surface reflects of light, and what is left for what lies below.
#include <algorithm>
#include <cmath>

#include "reference/optics.h"
#include "reference/shader.h"

namespace peelray::inline PRECISION {

using namespace optics;

real Shader::index_of(uint32_t medium, Channel channel) const {
    return medium == Media::air ? 1 : context_.surfaces.optics(medium).index(channel);
}

real Shader::relative_index(const Meeting& meeting, const Surface& s, Channel channel) const {
    const real own = s.optics.index(channel);
    if (!meeting.wall) return s.optics.leaves(s.front) ? 1 / own : own;
    return index_of(meeting.to, channel) / index_of(meeting.from, channel);
}

/// Between two media by their indices; in air as the material says.
Shader::Parts Shader::reflectance_at(const Meeting& meeting, const Surface& s, real cosine, Channel channel) const {
    const Optics& m = s.optics;
    if (meeting.wall && meeting.from != Media::air && meeting.to != Media::air) {
        Vec3 between;
        for (int k = 0; k < 3; k++)
            between[k] =
                fresnel_dielectric(cosine, relative_index(meeting, s, channel == Channel::all ? Channel(k) : channel));
        return {between, fresnel_schlick(m.base_color, 1, cosine)};
    }
    const bool leaving = meeting.wall ? meeting.to == Media::air : m.leaves(s.front);
    return {m.wall_reflectance(cosine, leaving, channel), m.metal_reflectance(cosine, leaving, channel)};
}

bool Shader::compensates(const Optics& m) const {
    return context_.settings.energy_compensation && m.lobe_roughness() >= MIRROR_ROUGHNESS;
}

/// Light that microfacets hide from the viewer goes on among them, and comes out in the end: by what times an opaque
/// surface reflects more than it does at the first of them (Turquin, Practical multiple scattering compensation for
/// microfacet models, 2019).
Shader::Parts Shader::compensation(const Surface& s, real n_v) const {
    const Optics& m = s.optics;
    if (!compensates(m)) return {};
    const Albedos::Means means = context_.albedos.at(s, n_v);
    const real kept = means.masking();
    Vec3 dielectric = m.f0, metal = m.base_color;
    if (m.film > 0) {
        dielectric = glm::mix(dielectric, m.film_on_dielectric(means.cosine(), false), m.film);
        if (m.metallic > 0) metal = glm::mix(metal, m.film_on_metal(means.cosine(), false), m.film);
    }
    // Of glass each microfacet's own light goes the other way: rough_glass().
    if (m.transmits()) dielectric = Vec3(0);
    return {1.0 + dielectric * ((1 - kept) / kept), 1.0 + metal * ((1 - kept) / kept)};
}

/// Of light from everywhere, what a rough surface reflects. What a film reflects, at the angle of its mean microfacet.
Shader::Parts Shader::mean_reflectance(const Surface& s, real n_v) const {
    const Optics& m = s.optics;
    const Albedos::Means means = context_.albedos.at(s, n_v);
    Parts mean{means.dielectric, means.metal(m.base_color)};
    if (m.film > 0) {
        const real kept = means.masking(), cosine = means.cosine();
        mean.dielectric = glm::mix(mean.dielectric, m.film_on_dielectric(cosine, false) * kept, m.film);
        if (m.metallic > 0) mean.metal = glm::mix(mean.metal, m.film_on_metal(cosine, false) * kept, m.film);
    }
    return mean * compensation(s, n_v);
}

/// Of a microfacet of glass whose reflected and refracted light others hide in part: what they hide goes both ways in
/// the end, as the rest does.
Shader::Shares Shader::rough_glass(const Vec3& fresnel, real kept_reflected, real kept_refracted) {
    Shares shares{fresnel, 1.0 - fresnel};
    for (int k = 0; k < 3; k++) {
        const real reflected = fresnel[k] * kept_reflected, refracted = (1 - fresnel[k]) * kept_refracted;
        if (reflected + refracted == 0) continue;
        shares.reflected[k] = reflected / (reflected + refracted);
        shares.refracted[k] = refracted / (reflected + refracted);
    }
    return shares;
}

/// What a sheen leaves of the light along a direction for what is below.
real Shader::below_sheen(const Surface& s, real cosine) const {
    const real most = largest(s.optics.sheen);
    return most > 0 ? 1 - most * context_.albedos.sheen(s, cosine) : 1;
}

}  // namespace peelray::inline PRECISION
