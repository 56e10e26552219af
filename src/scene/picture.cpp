#include "scene/picture.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "scene/sampling.h"
#include "settings/limits.h"

namespace peelray {

uint32_t bounce_levels(const PictureSettings& settings, bool has_blended) {
    if (!settings.refraction) return settings.reflection ? settings.bounces : 0;
    return std::min(settings.bounces + (has_blended ? BLENDED_PASSED : 0u), uint32_t(kBounceLimits.most));
}

uint32_t last_level(const PictureSettings& settings, bool has_blended) {
    return std::min(bounce_levels(settings, has_blended) + settings.gi, uint32_t(kBounceLimits.most));
}

float least_roughness(const Scene& scene, const Material& m) {
    const auto least = [&](float factor, const MaterialTexture& use) {
        return use ? factor * float(least_value(scene.textures[size_t(use.texture)], use.channel)) : factor;
    };
    const float own = least(m.roughness, m.roughness_texture);
    return m.clearcoat > 0 ? std::min(own, least(m.coat_roughness, m.coat_roughness_texture)) : own;
}

float most_roughness(const Material& m) {
    float own = m.roughness;
    if (m.anisotropy > 0) {
        const float across = std::max(own * own, float(MIRROR_ROUGHNESS * MIRROR_ROUGHNESS));
        const float along = across + (1 - across) * m.anisotropy * m.anisotropy;
        own = std::max(own, std::pow(along * across, 0.25f));
    }
    return m.clearcoat > 0 ? std::max(own, m.coat_roughness) : own;
}

bool is_reflective(const Scene& scene, uint32_t spp) {
    const auto reflects = [&](const Primitive& primitive) {
        const Material& m = scene.materials[primitive.material];
        if (primitive.triangles.empty()) return false;
        if (m.blended) return true;
        if (m.unlit) return false;
        return transmits(m) || is_reflection_traced(least_roughness(scene, m), m.metallic > float(MOSTLY_METAL), spp);
    };
    return std::any_of(scene.nodes.begin(), scene.nodes.end(), [&](const Node& node) {
        if (node.mesh < 0) return false;
        const std::vector<Primitive>& primitives = scene.meshes[size_t(node.mesh)].primitives;
        return std::any_of(primitives.begin(), primitives.end(), reflects);
    });
}

glm::vec2 sample_position(uint32_t index) {
    const double x = 0.5 + index * 0.7548776662466927, y = 0.5 + index * 0.5698402909980532;
    constexpr float below_one = 0x1.fffffep-1f;  // rounding reaches 1 once in some 16 million
    return {std::min(float(x - std::floor(x)), below_one), std::min(float(y - std::floor(y)), below_one)};
}

Camera turned(const Camera& camera, double turn) {
    Camera out = camera;
    if (turn == 0) return out;
    const double angle = 2 * 3.14159265358979323846 * turn, c = std::cos(angle), s = std::sin(angle);
    const auto rotate = [&](const glm::dvec3& v) { return glm::dvec3(c * v.x + s * v.z, v.y, c * v.z - s * v.x); };
    out.eye = glm::vec3(camera.look + rotate(camera.eye - camera.look));
    out.up = glm::vec3(rotate(camera.up));
    return out;
}

View make_view(const Camera& camera, float aspect, const glm::vec3& lower, const glm::vec3& upper) {
    const glm::dvec3 eye = camera.eye, look = camera.look - eye;
    const auto finite = [](const glm::dvec3& v) {
        return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
    };
    if (!finite(eye) || !finite(look) || !finite(glm::dvec3(camera.up)))
        fail("the camera's position is not finite: check {}, {} and {}", setting::eye, setting::look, setting::up);
    if (glm::length(look) == 0) fail("the camera looks at itself: {} and {} must differ", setting::eye, setting::look);
    const glm::dvec3 forward = glm::normalize(look);
    const glm::dvec3 side = glm::cross(forward, glm::dvec3(camera.up));
    if (glm::length(side) < 1e-9 * glm::length(glm::dvec3(camera.up)) || glm::length(glm::dvec3(camera.up)) == 0)
        fail("the camera looks along its up direction: choose another {}", setting::up);
    const glm::dvec3 right = glm::normalize(side), up = glm::cross(right, forward);

    View view;
    double half_height = camera.orthographic_height / 2;
    view.orthographic = camera.orthographic_height > 0;
    if (!view.orthographic) {
        if (!(camera.vertical_fov > 0 && camera.vertical_fov < 3.1415f))
            fail("a vertical field of view of {:.1f} degrees is impossible: choose one between 0 and 180 ({})",
                 camera.vertical_fov * 57.29578f, setting::fov);
        half_height = std::tan(double(camera.vertical_fov) / 2);
    }
    view.eye = camera.eye;
    view.forward = glm::vec3(forward);
    view.right = glm::vec3(right * half_height * double(aspect));
    view.up = glm::vec3(up * half_height);
    const double diagonal = glm::length(glm::dvec3(upper) - glm::dvec3(lower));
    const double away = glm::length(glm::dvec3(lower) + glm::dvec3(upper) - 2.0 * eye) / 2;
    view.near = float(std::max(diagonal, 1e-20) * 1e-5);
    view.far = float(std::max(away + diagonal, 1e-20));
    return view;
}

}  // namespace peelray
