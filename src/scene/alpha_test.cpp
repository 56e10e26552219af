#include "scene/alpha_test.h"

#include <algorithm>

#include "path/shading_numbers.h"
#include "scene/sampling.h"

namespace peelray {
bool has_masks(const Scene& scene, const std::vector<uint32_t>& triangle_materials) {
    return std::any_of(triangle_materials.begin(), triangle_materials.end(),
                       [&](uint32_t material) { return scene.materials[material].alpha_cutoff > 0; });
}

AlphaTest::AlphaTest(const Scene& scene, const Geometry& geometry) {
    if (!has_masks(scene, geometry.materials)) return;
    scene_ = &scene;
    geometry_ = &geometry;
}

bool AlphaTest::is_masked(uint32_t triangle) const {
    return scene_ && scene_->materials[geometry_->materials[triangle]].alpha_cutoff > 0;
}

bool AlphaTest::is_present(uint32_t triangle, double u, double v) const {
    if (!is_masked(triangle)) return true;
    const Material& m = scene_->materials[geometry_->materials[triangle]];
    const glm::uvec3 corners = geometry_->triangles[triangle];
    const auto interpolate = [&](const auto& a, const auto& b, const auto& c) { return a + (b - a) * u + (c - a) * v; };
    double alpha = double(m.alpha);
    if (const auto& colors = geometry_->colors; !colors.empty())
        alpha *= interpolate(double(colors[corners.x].w), double(colors[corners.y].w), double(colors[corners.z].w));
    if (const MaterialTexture& from = m.base_color_texture) {
        const auto& uvs = geometry_->uv_set(from.uv_set);
        const glm::dvec2 uv =
            interpolate(glm::dvec2(uvs[corners.x]), glm::dvec2(uvs[corners.y]), glm::dvec2(uvs[corners.z]));
        alpha *= sample_alpha(scene_->textures[size_t(from.texture)],
                              glm::dmat2(from.uv_matrix) * uv + glm::dvec2(from.uv_offset));
    }
    return alpha >= double(m.alpha_cutoff) - ALPHA_ROUNDING;
}

}  // namespace peelray
