// What the denoiser is guided by (shaders/denoise/denoise_guides.comp).
#include <algorithm>

#include "reference/optics.h"
#include "reference/shader.h"

namespace peelray::inline PRECISION {

using namespace optics;

namespace {

/// Is what the surface mirrors, below its coat or by it, drawn at random?
bool draws_mirrored(const Optics& m, const PictureSettings& settings) {
    const bool coat = m.clearcoat > 0 && m.coat_roughness >= MIRROR_ROUGHNESS;
    return is_sampled(settings) && (m.lobe_roughness() >= MIRROR_ROUGHNESS || coat);
}

/// Clear mirrors and glass hold no lamp, and nothing that scatters.
bool holds_light(const Optics& m) {
    const bool scatters = m.metallic < 1 && m.transmission < 1;
    return m.lobe_roughness() >= MIRROR_ROUGHNESS || scatters || m.clearcoat > 0 || largest(m.sheen) > 0;
}

}  // namespace

/// Which of a hit's branches the guides are to be looked for in; none: the hit has them, or there are none.
std::optional<uint32_t> Shader::guiding_branch(const Surface& surface, const Path& path, const Scattered& out) const {
    const Optics& m = surface.optics;
    if (!path.guided || m.unlit || draws_mirrored(m, context_.settings)) return {};
    const PictureSettings& settings = context_.settings;
    const bool lit = settings.shadow && (settings.env_mode == EnvironmentMode::sampled || !context_.lights.empty() ||
                                         context_.samples_emitters());
    if (holds_light(m) && (lit || settings.gi > 0 || occludes_sky(settings))) return {};
    const auto shown = [](const Branch& branch) { return branch.traced ? luminance(branch.weight) : 0; };
    const real first = shown(out.reflection), second = out.split.empty() ? shown(out.refraction) : 0;
    if (std::max(first, second) == 0) return {};
    return first >= second ? 0 : 1;
}

/// Where the hit of a guided path was before, or where the path goes on: what that makes of images.
void Shader::look_back(const Path& path, const Hit& hit, std::optional<uint32_t> guiding, const Scattered& out) {
    if (path.level == 0) {
        camera_origin_ = path.origin;
        camera_direction_ = path.direction;
    }
    const MomentBefore::Place place{hit.triangle, hit.u, hit.v};
    if (guiding) {
        const Branch& branch = *guiding == 0 ? out.reflection : out.refraction;
        image_ = context_.before->straightened(image_, place, glm::dvec3(path.direction), glm::dvec3(branch.direction));
        return;
    }
    std::optional<glm::dvec3> seen;
    if (path.level > 0) seen = glm::dvec3(camera_origin_) + double(path.length) * glm::dvec3(camera_direction_);
    guide_motion_ = context_.before->motion_of_image(place, image_, seen);
}

/// The guides of a hit; `all`: its light, `second`: of that what its second
/// branch shows, `lit`: of lamps and the sky.
void Shader::guide(const Surface& surface, const Path& path, const Vec3& all, const Vec3& second, const Vec3& lit) {
    const Optics& m = surface.optics;
    const bool mirrors = draws_mirrored(m, context_.settings);
    if (m.unlit || (!mirrors && !holds_light(m))) return;
    const bool clear_coat = m.clearcoat > 0 && m.coat_roughness < MIRROR_ROUGHNESS && !m.transmits();
    Vec3 light = lit;
    if (mirrors) {
        light = all - m.alpha * m.emissive;
        if (m.alpha < 1 || clear_coat) light -= second;
    }
    const real scatters = (1 - m.metallic) * (1 - m.transmission);
    const Vec3 front = scatters * m.base_color + m.sheen;
    const Vec3 scattered = glm::mix(front, scatters * m.behind_color, m.behind);
    const Vec3 normal = m.specified ? m.f0 : Vec3(m.normal);
    Vec3 mirrored = glm::mix(normal, m.base_color, m.metallic);
    if (m.transmits()) mirrored += m.tint();
    const Vec3 albedo = glm::max(scattered + mirrored + m.clearcoat * COAT_REFLECTANCE, Vec3(DENOISE_LEAST_ALBEDO));
    guide_.light = path.weight * glm::max(light, Vec3(0));
    guide_.albedo = path.weight * m.alpha * albedo;
    guide_.normal = surface.normal;
    guide_.depth = float(path.length);
    const real share = std::clamp(luminance(mirrored) / luminance(albedo), 0.0, 1.0);
    guide_.gloss = mirrors ? float(share * (1 - m.lobe_roughness())) : 0;
    guide_.surfaces = 1;
    guide_.mean = float(luminance(guide_.light) / std::max(luminance(guide_.albedo), 1e-20));
}

}  // namespace peelray::inline PRECISION
