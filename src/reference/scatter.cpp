// What a surface does with a ray: the branches that it sends out (docs/frame.md section 4).
#include <algorithm>
#include <cmath>

#include "reference/optics.h"
#include "reference/shader.h"

namespace peelray::inline PRECISION {

using namespace optics;

namespace {

Vec3 mirrored(const Vec3& direction, const Vec3& normal) {
    return direction - 2 * glm::dot(direction, normal) * normal;
}

}  // namespace

/// Part of a rough lobe that is traced; the rest sees the blurred environment. One sample cannot follow a wide lobe,
/// unless the environment's light is drawn too.
real Shader::traced_part(real roughness, real metallic) const {
    if (!context_.is_photon && (context_.samples_environment() || context_.filters_environment())) return 1;
    if (context_.sampled()) return photons_follow(roughness, metallic) ? 1 : 0;
    const real x =
        std::clamp((roughness - FADE_FIRST_ROUGHNESS) / (FADE_LAST_ROUGHNESS - FADE_FIRST_ROUGHNESS), 0.0, 1.0);
    return 1 - x * x * (3 - 2 * x);
}

Lobe Shader::lobe_of(const Surface& s) {
    const Vec2 alphas = s.optics.alphas();
    return s.optics.anisotropy > 0 ? Lobe(s.normal, s.along, alphas) : Lobe(s.normal, alphas.x);
}

Lobe Shader::coat_lobe(const Surface& s) {
    return Lobe(s.coat_normal, s.optics.coat_roughness * s.optics.coat_roughness);
}

/// What a microfacet of the coat mirrors.
real Shader::coat_reflectance(const Optics& m, real v_h) {
    return m.clearcoat * fresnel_schlick(Vec3(COAT_REFLECTANCE), 1, v_h).x;
}

/// The half vector: the normal itself for mirrors and where one stands for all, else a sample of the visible normals.
Vec3 Shader::half_vector(const Lobe& lobe, const Path& path, uint32_t purpose) const {
    if (!context_.sampled() || lobe.alpha.x < MIRROR_ROUGHNESS * MIRROR_ROUGHNESS) return lobe.n;
    return lobe.sample(-path.direction, random(path, purpose));
}

/// Path::density of what a lobe reflects. Where a coat shares a branch with what is below, it has none.
real Shader::reflection_density(const Surface& s, const Lobe& lobe, const Path& path, const Vec3& reflected) const {
    if (!context_.sampled() || s.optics.shares_branch()) return 0;
    return lobe.density(-path.direction, reflected);
}

/// That of the surface below the coat. One sample looks where a stretched lobe's light comes from on the whole: the
/// normal turns towards the viewer, across the lobe (KHR_materials_anisotropy).
Vec3 Shader::microfacet(const Surface& s, const Lobe& lobe, const Path& path) const {
    const Optics& m = s.optics;
    const Vec3 view = -path.direction;
    if (m.anisotropy == 0 || context_.sampled()) return half_vector(lobe, path, RANDOM_MICROFACET);
    const Vec3 across = view - glm::dot(view, lobe.b) * lobe.b;
    const Vec3 turned = glm::dot(across, across) > 0 ? glm::normalize(across) : s.normal;
    return glm::normalize(glm::mix(turned, s.normal, square(square(1 - m.anisotropy * (1 - m.roughness)))));
}

/// Where light goes on behind a surface that transmits; nowhere at total internal reflection. A thin wall bends light
/// back to where it came from: a rough one blurs what is behind as it blurs what it mirrors.
std::optional<Vec3> Shader::refracted(const Surface& s, const Path& path, const Meeting& meeting,
                                      const Vec3& half) const {
    const bool rough = s.optics.lobe_roughness() >= MIRROR_ROUGHNESS;
    if (!s.optics.thin) return refract_ray(path.direction, half, relative_index(meeting, s, path.channel));
    if (!rough || !context_.sampled()) return path.direction;
    return mirrored(mirrored(path.direction, half), s.normal);
}

/// By a microfacet, or by all of them where one sample stands for the lobe.
Shader::Shares Shader::shares(const Surface& s, const Lobe& lobe, const Path& path, const Meeting& meeting,
                              const Vec3& half) const {
    const Optics& m = s.optics;
    const real n_v = std::clamp(-glm::dot(path.direction, s.normal), 0.0, 1.0),
               v_h = std::clamp(-glm::dot(path.direction, half), 0.0, 1.0);
    const Parts fresnel = reflectance_at(meeting, s, v_h, path.channel);
    const Vec3 passed = 1.0 - fresnel.dielectric;
    if (m.lobe_roughness() < MIRROR_ROUGHNESS) return {fresnel.of(m), passed};
    const bool sampled = context_.sampled();
    if (!m.transmits() && !sampled) return {mean_reflectance(s, n_v).of(m), passed};
    const real kept = sampled ? lobe.masking(mirrored(path.direction, half)) : context_.albedos.at(s, n_v).masking();
    if (!m.transmits()) return {(fresnel * compensation(s, n_v)).of(m) * kept, passed};
    if (!compensates(m)) return {fresnel.of(m) * kept, passed};
    if (!sampled) return {glm::mix(fresnel.dielectric, mean_reflectance(s, n_v).metal, m.metallic), passed};
    const auto onward = refracted(s, path, meeting, half);
    const Shares glass = rough_glass(fresnel.dielectric, kept, onward ? lobe.masking(-*onward) : 0);
    const Vec3 metal = fresnel.metal * compensation(s, n_v).metal * kept;
    return {glm::mix(glass.reflected, metal, m.metallic), glass.refracted};
}

/// Does light that is refracted here come apart?
bool Shader::disperses(const Surface& s, const Path& path, const Meeting& meeting) const {
    if (path.channel != Channel::all || !s.optics.transmits() || s.optics.thin || s.optics.alpha < 1) return false;
    const real middle = relative_index(meeting, s, Channel::green);
    return relative_index(meeting, s, Channel::red) != middle || relative_index(meeting, s, Channel::blue) != middle;
}

/// Each channel's ray takes its own way from the same microfacet; what is reflected totally has gone with the rest.
void Shader::split(const Path& path, const Meeting& meeting, const Surface& s, const Vec3& half, Scattered& out) const {
    for (const Channel channel : {Channel::red, Channel::green, Channel::blue}) {
        const real eta = relative_index(meeting, s, channel);
        const auto direction = refract_ray(path.direction, half, eta);
        Branch part = out.refraction;
        part.weight = Vec3(0);
        if (direction) part.weight[int(channel)] = out.refraction.weight[int(channel)];
        part.direction = direction.value_or(path.direction);
        part.channel = channel;
        out.split.push_back(part);
    }
}

/// All branches of a surface, and what it sends by itself.
Shader::Scattered Shader::scatter(const Surface& s, const Path& path, const Meeting& meeting) const {
    const Optics& m = s.optics;
    const bool sampled = context_.sampled();
    Scattered out;
    if (m.unlit) {
        out.radiance = m.base_color;
        if (m.alpha < 1) pass_beside(s, path, meeting, out);
        return out;
    }
    const real roughness = m.lobe_roughness();
    const bool transmits = m.transmits(), mirror = roughness < MIRROR_ROUGHNESS;
    const Lobe lobe = lobe_of(s);
    const Vec3 h = microfacet(s, lobe, path);
    const Shares share = shares(s, lobe, path, meeting, h);
    const real below = below_sheen(s, -glm::dot(path.direction, s.normal));

    Branch& reflection = out.reflection;
    reflection.weight = share.reflected * below;
    reflection.direction = above_surface(mirrored(path.direction, h), s.geometric);
    reflection.media = meeting.before;
    reflection.cone = lobe_cone(path.cone.reflected(s.curvature), roughness, 1);
    reflection.sees_sun = mirror && path.sees_sun;
    reflection.density = reflection_density(s, lobe, path, reflection.direction);
    reflection.traced = is_traced(reflection, path);
    reflection.blur = sampled ? 0 : roughness;

    out.radiance = m.emissive * emission_share(path, meeting.hit);
    if (!transmits) out.radiance += fade(reflection, roughness, m.metallic);
    const auto direction = transmits ? refracted(s, path, meeting, h) : std::nullopt;
    const bool comes_apart = disperses(s, path, meeting);
    if (direction || comes_apart) {
        Branch& refraction = out.refraction;
        refraction.weight = share.refracted * m.tint() * below;
        refraction.direction = direction.value_or(path.direction);
        if (m.thin && !mirror && sampled) refraction.direction = above_surface(refraction.direction, -s.geometric);
        refraction.media = meeting.behind;
        const real eta = relative_index(meeting, s, path.channel);
        // A microfacet turns what it refracts less than what it mirrors, as Snell's law has it near the normal.
        const real part = std::abs(1 - 1 / eta) / 2;
        refraction.cone = m.thin ? lobe_cone(path.cone, roughness, 1)
                                 : lobe_cone(path.cone.refracted(s.curvature, eta), roughness, part);
        refraction.sees_sun = mirror && path.sees_sun;
        refraction.density = path.density;  // light rays go straight through
        refraction.mirrors = false;
        refraction.traced = is_traced(refraction, path);
        refraction.weight *= meeting.beside;
    }
    if (m.clearcoat > 0) add_coat(s, path, meeting, out);
    if (m.alpha < 1) pass_beside(s, path, meeting, out);
    if (comes_apart) split(path, meeting, s, h, out);
    return out;
}

/// What the untraced part of a wide lobe sees, at once; the branch keeps the rest.
Vec3 Shader::fade(Branch& branch, real roughness, real metallic) const {
    const real part = traced_part(roughness, metallic);
    if (part == 1) return Vec3(0);
    const Vec3 seen = branch.weight * (1 - part) * context_.surroundings.radiance(branch.direction, roughness);
    branch.weight *= part;
    branch.traced = branch.traced && part > 0;
    return seen;
}

/// A clear coat takes its share of the light and lets the rest through, both ways at once (KHR_materials_clearcoat).
/// What it mirrors is the second branch of an opaque surface; glass and blended surfaces mirror it with their own.
void Shader::add_coat(const Surface& s, const Path& path, const Meeting& meeting, Scattered& out) const {
    const Optics& m = s.optics;
    const Vec3 view = -path.direction;
    const real share = context_.albedos.coat(s, glm::dot(view, s.coat_normal));
    out.radiance *= 1 - share;
    out.reflection.weight *= 1 - share;
    out.refraction.weight *= 1 - share;
    const bool has_second = m.shares_branch();
    if (has_second && largest(out.reflection.weight) > 0) {
        out.reflection.weight += share;
        out.reflection.traced = is_traced(out.reflection, path);
        return;
    }
    const bool mirror = m.coat_roughness < MIRROR_ROUGHNESS, sampled = !mirror && context_.sampled();
    const Lobe lobe = coat_lobe(s);
    const Vec3 h = half_vector(lobe, path, RANDOM_COAT);
    const Vec3 reflected = mirrored(path.direction, h);
    Branch coat;
    coat.weight = Vec3(share);
    if (sampled)
        coat.weight = Vec3(coat_reflectance(m, std::clamp(glm::dot(view, h), 0.0, 1.0)) * lobe.masking(reflected));
    coat.direction = above_surface(reflected, s.geometric);
    coat.media = meeting.before;
    coat.cone = lobe_cone(path.cone.reflected(s.curvature), m.coat_roughness, 1);
    coat.sees_sun = mirror && path.sees_sun;
    coat.density = reflection_density(s, lobe, path, coat.direction);
    coat.traced = is_traced(coat, path);
    out.radiance += fade(coat, m.coat_roughness, 0);
    coat.blur = context_.sampled() ? 0 : m.coat_roughness;
    (has_second ? out.reflection : out.refraction) = coat;
}

/// What of a surface's light is left where it covers a part only; what lets pass the rest is its second branch. Thin
/// glass sends its light the same way.
void Shader::pass_beside(const Surface& s, const Path& path, const Meeting& meeting, Scattered& out) const {
    const real alpha = s.optics.alpha;
    out.radiance *= alpha;
    out.reflection.weight *= alpha;
    Branch on;
    on.weight = alpha * out.refraction.weight + (1 - alpha);
    on.direction = path.direction;
    on.media = meeting.behind;
    on.cone = path.cone;
    on.passes = true;
    on.sees_sun = path.sees_sun;
    on.density = path.density;
    on.mirrors = false;
    on.traced = is_traced(on, path);
    out.refraction = on;
}

}  // namespace peelray::inline PRECISION
