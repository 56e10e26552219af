#include "reference/shader.h"

#include <algorithm>
#include <cmath>

#include "base/infinity.h"
#include "reference/optics.h"

namespace peelray {
namespace {

using namespace optics;

/// Part of a rough lobe that is traced; the rest sees the blurred environment. One sample cannot follow a wide lobe.
double traced_part(double roughness, double metallic, uint32_t spp) {
    if (spp > 1) return roughness < TRACED_ROUGHNESS || metallic > MOSTLY_METAL ? 1 : 0;
    const double x =
        std::clamp((roughness - FADE_FIRST_ROUGHNESS) / (FADE_LAST_ROUGHNESS - FADE_FIRST_ROUGHNESS), 0.0, 1.0);
    return 1 - x * x * (3 - 2 * x);
}

/// A light as a point of a surface meets it.
struct Incidence {
    glm::dvec3 irradiance{0};  ///< on a surface that faces the light; 0: none
    glm::dvec3 direction;      ///< to the light, unit
};

Incidence incidence(const Light& light, const glm::dvec3& position) {
    if (light.kind == Light::Kind::directional) return {light.color, -glm::dvec3(light.direction)};
    const glm::dvec3 to_light = glm::dvec3(light.position) - position;
    const double distance = glm::length(to_light);
    if (distance == 0) return {};
    const glm::dvec3 direction = to_light / distance;
    // KHR_lights_punctual: inverse square with a smooth end at the range, a squared ramp between the cones.
    double strength = 1 / (distance * distance);
    if (std::isfinite(light.range)) strength *= std::clamp(1 - std::pow(distance / light.range, 4), 0.0, 1.0);
    if (light.kind == Light::Kind::spot) {
        const double inner = std::cos(double(light.inner_cone)), outer = std::cos(double(light.outer_cone));
        const double cosine = glm::dot(glm::dvec3(light.direction), -direction);
        const double ramp = std::clamp((cosine - outer) / std::max(0.001, inner - outer), 0.0, 1.0);
        strength *= ramp * ramp;
    }
    return {glm::dvec3(light.color) * strength, direction};
}

/// The lobe of GGX around a normal, times the cosine; less Fresnel's share.
double highlight(const glm::dvec3& normal, double roughness, const glm::dvec3& view, const glm::dvec3& to_light) {
    const double n_l = glm::dot(normal, to_light);
    if (n_l <= 0 || roughness < MIRROR_ROUGHNESS) return 0;
    const double n_v = std::max(GRAZING_COSINE, glm::dot(normal, view)),
                 n_h = std::clamp(glm::dot(normal, glm::normalize(view + to_light)), 0.0, 1.0);
    const double alpha = roughness * roughness;
    return ggx_distribution(n_h, alpha) * ggx_masking(n_v, alpha) * ggx_masking(n_l, alpha) / (4 * n_v);
}

}  // namespace

/// Reflected share of light from `to_light`, times the cosine: Lambert below GGX, both below the coat.
glm::dvec3 Shader::reflectance(const Surface& s, const glm::dvec3& view, const glm::dvec3& to_light) const {
    const Optics& m = s.optics;
    const double n_l = glm::dot(s.normal, to_light),
                 v_h = std::clamp(glm::dot(view, glm::normalize(view + to_light)), 0.0, 1.0);
    glm::dvec3 share(0);
    if (n_l > 0) {
        const glm::dvec3 dielectric = m.face_reflectance(v_h, m.leaves(s.front));
        share = (1 - m.metallic) * (1 - m.transmission) * (1 - largest(dielectric)) * m.base_color * (n_l / pi);
        const glm::dvec3 fresnel = glm::mix(dielectric, fresnel_schlick(m.base_color, 1, v_h), m.metallic);
        share += fresnel * highlight(s.normal, m.roughness, view, to_light);
    }
    if (m.clearcoat == 0) return share;
    const double coat = m.clearcoat * fresnel_schlick(glm::dvec3(COAT_REFLECTANCE), 1, v_h).x;
    return share * (1 - context_.albedos.coat(s, glm::dot(view, s.coat_normal))) +
           coat * highlight(s.coat_normal, m.coat_roughness, view, to_light);
}

Meeting Shader::hit(const Path& path) const {
    return walk().next({path.origin, 0, path.direction, infinity}, path.skip, path.media);
}

double Shader::index_of(uint32_t medium) const {
    return medium == Media::air ? 1 : context_.surfaces.optics(medium).ior;
}

double Shader::relative_index(const Meeting& meeting, const Surface& s) const {
    const Optics& m = s.optics;
    if (!meeting.wall) return m.leaves(s.front) ? 1 / m.ior : m.ior;
    return index_of(meeting.to) / index_of(meeting.from);
}

/// Between two media by their indices; in air as the material says.
glm::dvec3 Shader::reflectance_at(const Meeting& meeting, const Surface& s, double cosine) const {
    const Optics& m = s.optics;
    if (meeting.wall && meeting.from != Media::air && meeting.to != Media::air)
        return glm::dvec3(fresnel_dielectric(cosine, relative_index(meeting, s)));
    return m.wall_reflectance(cosine, meeting.wall ? meeting.to == Media::air : m.leaves(s.front));
}

glm::dvec3 Shader::transmittance(uint32_t medium, double distance) const {
    return medium == Media::air ? glm::dvec3(1) : glm::exp(-context_.surfaces.optics(medium).absorption * distance);
}

glm::dvec3 Shader::radiance(const Path& arriving, const Meeting& meeting) {
    const OracleHit& hit = meeting.hit;
    if (!hit.hit()) return meeting.passed * context_.surroundings.seen(arriving.direction, arriving.sees_sun);
    const double width = arriving.cone.width_at(hit.t);
    Surface surface = context_.surfaces.at(hit.triangle, hit.u, hit.v, arriving.direction, width);
    surface.error = std::max(surface.error, meeting.lift);
    const glm::dvec3 kept = meeting.passed * transmittance(meeting.before.counting(context_.media), hit.t);
    Path path = arriving;
    path.weight *= kept;
    path.media = meeting.before;
    path.cone.width = width;  // at the hit
    const Scattered scattered = scatter(surface, path, meeting);
    glm::dvec3 sum = scattered.radiance;
    if (path.level == 0 && surface.optics.unlit) {
        const Branch& on = scattered.refraction;
        unlit_ =
            kept * (sum + (on.traced ? glm::dvec3(0) : on.weight * context_.surroundings.radiance(on.direction, 0)));
    }
    // The reference goes on in all of them; the GPU's rays do not.
    if (path.level > 0) rays_.crowded += meeting.behind.kinds() > std::max<size_t>(MEDIA_TOGETHER, path.media.kinds());
    if (scattered.reflection.traced) rays_.reflection++;
    const bool mirrors = scattered.refraction.mirrors;
    if (scattered.refraction.traced) (mirrors ? rays_.reflection : rays_.refraction)++;
    rays_.cut_reflection += is_cut(scattered.reflection, path);
    (mirrors ? rays_.cut_reflection : rays_.cut_refraction) += is_cut(scattered.refraction, path);
    sum += follow(scattered.reflection, surface, path, hit.triangle, 0);
    sum += follow(scattered.refraction, surface, path, hit.triangle, 1);
    sum += surface.optics.alpha * direct_light(surface, hit.triangle, path);
    return kept * sum;
}

/// The light of one of a hit's two branches.
glm::dvec3 Shader::follow(const Branch& branch, const Surface& surface, const Path& path, uint32_t triangle,
                          uint32_t which) {
    if (branch.weight == glm::dvec3(0)) return glm::dvec3(0);
    if (!branch.traced) return branch.weight * context_.surroundings.radiance(branch.direction, branch.blur);
    Path next;
    next.origin = surface.start(surface.position, branch.direction);
    next.direction = branch.direction;
    next.skip = triangle;
    next.weight = path.weight * branch.weight;
    next.media = branch.media;
    next.cone = branch.cone;
    next.sees_sun = branch.sees_sun;
    next.seed = hash3({path.seed, which, path.level}).x;
    next.level = path.level + 1;
    next.passed = path.passed + branch.passes;
    return branch.weight * radiance(next, hit(next));
}

/// Has the path come as far as it is followed?
bool Shader::is_last(const Branch& branch, const Path& path) const {
    const uint32_t last = last_level(context_.settings, context_.has_blended);
    return path.level >= (branch.passes ? last : std::min(last, context_.settings.bounces + path.passed));
}

/// Is it bright enough, and its effect on?
bool Shader::is_wanted(const Branch& branch, const Path& path) const {
    const bool effect = branch.mirrors ? context_.settings.reflection : context_.settings.refraction;
    return effect && largest(branch.weight * path.weight) >= LEAST_WEIGHT;
}

bool Shader::is_traced(const Branch& branch, const Path& path) const {
    return is_wanted(branch, path) && !is_last(branch, path);
}

/// Would it be traced if it were not too far along the path? With no bounces at all nobody asked for it.
bool Shader::is_cut(const Branch& branch, const Path& path) const {
    return context_.settings.bounces > 0 && path.level > 0 && is_wanted(branch, path) && is_last(branch, path);
}

/// The half vector: the normal itself for mirrors and with one sample per pixel, else a sample of the visible normals.
glm::dvec3 Shader::half_vector(const glm::dvec3& normal, const glm::dvec3& view, double alpha, uint32_t seed,
                               Purpose purpose) const {
    if (context_.settings.spp <= 1 || alpha < MIRROR_ROUGHNESS * MIRROR_ROUGHNESS) return normal;
    const auto [t, b] = tangents(normal);
    const glm::dvec3 local(glm::dot(view, t), glm::dot(view, b), std::max(GRAZING_COSINE, glm::dot(view, normal)));
    const glm::dvec3 h = sample_ggx(glm::normalize(local), alpha, random_pair(seed, sample_, purpose));
    return glm::normalize(t * h.x + b * h.y + normal * h.z);
}

/// Both branches of a surface, and what it sends by itself (docs/frame.md section 4).
Shader::Scattered Shader::scatter(const Surface& s, const Path& path, const Meeting& meeting) const {
    const Optics& m = s.optics;
    const PictureSettings& settings = context_.settings;
    Scattered out;
    if (m.unlit) {
        out.radiance = m.base_color;
        if (m.alpha < 1) pass_beside(s, path, meeting, out);
        return out;
    }
    const glm::dvec3 view = -path.direction;
    const bool transmits = m.transmits(), mirror = m.roughness < MIRROR_ROUGHNESS;
    const double alpha = m.roughness * m.roughness;
    const glm::dvec3 h = half_vector(s.normal, view, alpha, path.seed, Purpose::microfacet);
    const double cosine = std::clamp(glm::dot(view, h), 0.0, 1.0);
    const glm::dvec3 dielectric = reflectance_at(meeting, s, cosine);

    Branch& reflection = out.reflection;
    const glm::dvec3 reflected = path.direction - 2 * glm::dot(path.direction, h) * h;
    reflection.weight = glm::mix(dielectric, fresnel_schlick(m.base_color, 1, cosine), m.metallic);
    if (!mirror && settings.spp > 1) {
        const double above = glm::dot(reflected, s.normal);
        reflection.weight *= above > 0 ? ggx_masking(above, alpha) : 0;
    } else if (!mirror) {
        const Albedos::Means means = context_.albedos.at(s, cosine);
        reflection.weight = transmits ? reflection.weight * (means.normal + means.grazing)
                                      : glm::mix(means.dielectric, means.metal(m.base_color), m.metallic);
    }
    reflection.direction = above_surface(reflected, s.geometric);
    reflection.media = meeting.before;
    reflection.cone = path.cone.reflected(s.curvature);
    reflection.sees_sun = mirror && path.sees_sun;
    reflection.traced = is_traced(reflection, path);
    reflection.blur = settings.spp > 1 ? 0 : m.roughness;

    out.radiance = m.emissive;
    if (!transmits) out.radiance += fade(reflection, m.roughness, m.metallic);
    const auto direction = !transmits ? std::nullopt
                           : m.thin   ? std::optional(path.direction)
                                      : refract_ray(path.direction, h, relative_index(meeting, s));
    if (direction) {
        Branch& refraction = out.refraction;
        refraction.weight = (1.0 - dielectric) * m.tint();
        refraction.direction = *direction;
        refraction.media = meeting.behind;
        refraction.cone = m.thin ? path.cone : path.cone.refracted(s.curvature, relative_index(meeting, s));
        refraction.sees_sun = mirror && path.sees_sun;
        refraction.mirrors = false;
        refraction.traced = is_traced(refraction, path);
        refraction.weight *= meeting.beside;
    }
    if (m.clearcoat > 0) add_coat(s, path, meeting, out);
    if (m.alpha < 1) pass_beside(s, path, meeting, out);
    return out;
}

/// What the untraced part of a wide lobe sees, at once; the branch keeps the rest.
glm::dvec3 Shader::fade(Branch& branch, double roughness, double metallic) const {
    const double part = traced_part(roughness, metallic, context_.settings.spp);
    if (part == 1) return glm::dvec3(0);
    const glm::dvec3 seen = branch.weight * (1 - part) * context_.surroundings.radiance(branch.direction, roughness);
    branch.weight *= part;
    branch.traced = branch.traced && part > 0;
    return seen;
}

/// A clear coat takes its share of the light and lets the rest through, both ways at once (KHR_materials_clearcoat).
/// What it mirrors is the second branch of an opaque surface; glass and blended surfaces mirror it with their own.
void Shader::add_coat(const Surface& s, const Path& path, const Meeting& meeting, Scattered& out) const {
    const Optics& m = s.optics;
    const glm::dvec3 view = -path.direction;
    const double share = context_.albedos.coat(s, glm::dot(view, s.coat_normal));
    out.radiance *= 1 - share;
    out.reflection.weight *= 1 - share;
    out.refraction.weight *= 1 - share;
    const bool has_second = m.transmits() || m.alpha < 1;
    if (has_second && largest(out.reflection.weight) > 0) {
        out.reflection.weight += share;
        out.reflection.traced = is_traced(out.reflection, path);
        return;
    }
    const bool mirror = m.coat_roughness < MIRROR_ROUGHNESS, sampled = !mirror && context_.settings.spp > 1;
    const double alpha = m.coat_roughness * m.coat_roughness;
    const glm::dvec3 h = half_vector(s.coat_normal, view, alpha, path.seed, Purpose::coat);
    const glm::dvec3 reflected = path.direction - 2 * glm::dot(path.direction, h) * h;
    Branch coat;
    coat.weight = glm::dvec3(share);
    if (sampled) {
        const double above = glm::dot(reflected, s.coat_normal);
        coat.weight = m.clearcoat * (above > 0 ? ggx_masking(above, alpha) : 0) *
                      fresnel_schlick(glm::dvec3(COAT_REFLECTANCE), 1, std::clamp(glm::dot(view, h), 0.0, 1.0));
    }
    coat.direction = above_surface(reflected, s.geometric);
    coat.media = meeting.before;
    coat.cone = path.cone.reflected(s.curvature);
    coat.sees_sun = mirror && path.sees_sun;
    coat.traced = is_traced(coat, path);
    out.radiance += fade(coat, m.coat_roughness, 0);
    coat.blur = context_.settings.spp > 1 ? 0 : m.coat_roughness;
    (has_second ? out.reflection : out.refraction) = coat;
}

/// What of a surface's light is left where it covers a part only; what lets pass the rest is its second branch. Thin
/// glass sends its light the same way.
void Shader::pass_beside(const Surface& s, const Path& path, const Meeting& meeting, Scattered& out) const {
    const double alpha = s.optics.alpha;
    out.radiance *= alpha;
    out.reflection.weight *= alpha;
    Branch on;
    on.weight = alpha * out.refraction.weight + (1 - alpha);
    on.direction = path.direction;
    on.media = meeting.behind;
    on.cone = path.cone;
    on.passes = true;
    on.sees_sun = path.sees_sun;
    on.mirrors = false;
    on.traced = is_traced(on, path);
    out.refraction = on;
}

/// Light from the lamps, the sun and the diffuse sky (docs/frame.md section 5).
glm::dvec3 Shader::direct_light(const Surface& s, uint32_t triangle, const Path& path) {
    const Optics& m = s.optics;
    if (m.unlit) return glm::dvec3(0);
    const glm::dvec3 view = -path.direction;
    glm::dvec3 sum(0);
    for (const Light& light : context_.lights) {
        const auto [irradiance, direction] = incidence(light, s.position);
        if (irradiance == glm::dvec3(0)) continue;
        const glm::dvec3 reflected = irradiance * reflectance(s, view, direction);
        if (reflected == glm::dvec3(0)) continue;
        if (!context_.settings.shadow) {
            sum += reflected;
            continue;
        }
        // A triangle that turns away from the light is itself in the way where it is no part of a bulge.
        if (context_.surfaces.blocks_itself(s, triangle, direction)) continue;
        rays_.shadow++;
        const glm::dvec3 start = s.lit_start();
        const bool far = light.kind == Light::Kind::directional;
        const double reach = far ? infinity : glm::dot(glm::dvec3(light.position) - start, direction);
        sum += reflected * visibility(start, direction, reach, triangle, path.media);
    }
    return sum + sky_light(s, triangle, path);
}

glm::dvec3 Shader::sky_light(const Surface& s, uint32_t triangle, const Path& path) {
    const Optics& m = s.optics;
    glm::dvec3 diffuse = (1 - m.metallic) * (1 - m.transmission) * m.base_color / pi;
    if (diffuse == glm::dvec3(0)) return diffuse;
    // What the surface mirrors is not available for diffuse light: the share that scatter() gives to the reflection.
    const double cosine = std::clamp(-glm::dot(path.direction, s.normal), 0.0, 1.0);
    diffuse *= 1 - context_.albedos.coat(s, -glm::dot(path.direction, s.coat_normal));
    diffuse *= 1 - largest(m.roughness < MIRROR_ROUGHNESS ? m.face_reflectance(cosine, m.leaves(s.front))
                                                          : context_.albedos.at(s, cosine).dielectric);
    const glm::dvec3 light = m.occlusion * diffuse * context_.surroundings.irradiance(s.normal);
    if (!context_.settings.ambient) return light;
    // One cosine-distributed direction per sample: its mean is the sky that the surface really sees.
    const glm::dvec2 random = random_pair(path.seed, sample_, Purpose::sky);
    const auto [t, b] = tangents(s.normal);
    const double r = std::sqrt(random.x), phi = 2 * pi * random.y;
    const glm::dvec3 up = s.normal * std::sqrt(std::max(0.0, 1 - random.x));
    const glm::dvec3 direction = above_surface(t * (r * std::cos(phi)) + b * (r * std::sin(phi)) + up, s.geometric);
    rays_.ambient++;
    return light * visibility(s.start(s.shadow_start, direction), direction, infinity, triangle, path.media);
}

/// Share of the light that arrives from `distance` away: 0 or 1, or the tint of the glass in between.
glm::dvec3 Shader::visibility(const glm::dvec3& start, const glm::dvec3& direction, double distance, uint32_t triangle,
                              Media media) const {
    glm::dvec3 share(1);
    uint32_t skip = triangle;
    double from = 0;
    for (int layer = 0; layer < SHADOW_LAYERS; layer++) {
        Meeting meeting = walk().next({start, from, direction, distance}, skip, media, true);
        const OracleHit& hit = meeting.hit;
        share *= meeting.passed;
        if (!hit.hit()) return share;
        const Surface s = context_.surfaces.at(hit.triangle, hit.u, hit.v, direction);
        const Optics& m = s.optics;
        if (!m.transmits() && m.alpha == 1) return glm::dvec3(0);
        const double cosine = std::clamp(-glm::dot(direction, s.normal), 0.0, 1.0);
        const glm::dvec3 tint = (1.0 - reflectance_at(meeting, s, cosine)) * m.tint();
        share *= glm::mix(glm::dvec3(1), tint, m.alpha) * meeting.beside;
        // Light goes straight on: refraction would make it miss the lamp. Volumes absorb what crosses them.
        share *= transmittance(meeting.wall ? meeting.from : meeting.before.counting(context_.media), hit.t - from);
        if (largest(share) < LEAST_WEIGHT) return glm::dvec3(0);
        from = meeting.beyond;
        skip = meeting.last;
        media = std::move(meeting.behind);
    }
    return glm::dvec3(0);
}

}  // namespace peelray
