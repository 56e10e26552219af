#include "assembly/emitters.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "scene/mipmaps.h"
#include "scene/picture.h"
#include "scene/probabilities.h"
#include "scene/sampling.h"

namespace peelray {
namespace {

/// Of the power of a material's mean texel: what a triangle counts as at least.
constexpr double kLeastShare = 0.02;

/// What materials emit, over their triangles.
class Emission {
  public:
    explicit Emission(const Scene& scene) : scene_(scene), mipmaps_(scene), means_(scene.materials.size()) {
        for (size_t i = 0; i < means_.size(); i++) {
            const Material& m = scene.materials[i];
            if (!is_emissive(m)) continue;
            means_[i] = mean_color(glm::dvec3(m.emissive) *
                                   (m.emissive_texture ? texture_mean(m.emissive_texture.texture) : glm::dvec3(1)));
        }
    }

    bool any() const {
        return std::ranges::any_of(means_, [](double mean) { return mean > 0; });
    }
    bool emits(uint32_t material) const { return means_[material] > 0; }

    /// `corners`: texture coordinates of the material's emissive texture.
    double at(uint32_t material, const glm::dvec2 (&corners)[3]) const {
        const Material& m = scene_.materials[material];
        if (!m.emissive_texture) return means_[material];
        const glm::dvec2 lower = glm::min(corners[0], glm::min(corners[1], corners[2])),
                         upper = glm::max(corners[0], glm::max(corners[1], corners[2]));
        const Texture& texture = scene_.textures[size_t(m.emissive_texture.texture)];
        // The level of which the box covers some four texels a side, looked up at four times as many places.
        const std::vector<Texture>& levels = mipmaps_.of(m.emissive_texture.texture, false);
        const glm::dvec2 texels = (upper - lower) * glm::dvec2(texture.width, texture.height);
        const double lod = std::log2(std::max({texels.x, texels.y, 4.0}) / 4);
        const size_t level = std::min(size_t(lod + 0.5), levels.size());
        glm::dvec3 sum(0);
        constexpr int side = 6;
        for (int i = 0; i < side * side; i++)
            sum += sample_color(level == 0 ? texture : levels[level - 1],
                                lower + (upper - lower) * (glm::dvec2(i % side, i / side) + 0.5) / double(side), false);
        const double mean = mean_color(glm::dvec3(m.emissive) * sum / double(side * side));
        return std::max(mean, kLeastShare * means_[material]);
    }

  private:
    glm::dvec3 texture_mean(int index) const {
        const Texture& texture = scene_.textures[size_t(index)];
        const std::vector<Texture>& levels = mipmaps_.of(index, false);
        return sample_color(levels.empty() ? texture : levels.back(), glm::dvec2(0.5), false);
    }

    const Scene& scene_;
    Mipmaps mipmaps_;
    std::vector<double> means_;  ///< of each material; 0: it emits nothing
};

}  // namespace

Emitters emitters_of(const Scene& scene, const Assembly& assembly) {
    const Emission emission(scene);
    Emitters emitters;
    if (!emission.any()) return emitters;
    const Moment rest = at_rest(scene);
    std::vector<double> powers;
    for (uint32_t i = 0; i < assembly.instances.size(); i++) {
        const Assembly::Instance& instance = assembly.instances[i];
        const Assembly::Body& body = assembly.bodies[instance.body];
        const glm::dmat3 linear(instance.node < 0 ? glm::mat4(1)
                                                  : rest.worlds[size_t(instance.node)] * instance.offset);
        for (uint32_t t = body.first_triangle; t < body.first_triangle + body.triangles; t++) {
            const uint32_t material = assembly.materials[t];
            if (!emission.emits(material)) continue;
            const glm::uvec3 corners = assembly.triangles[t];
            const glm::dvec3 a(assembly.positions[corners.x]), b(assembly.positions[corners.y]),
                c(assembly.positions[corners.z]);
            const double area = glm::length(glm::cross(linear * (b - a), linear * (c - a)));
            if (!(area > 0) || !std::isfinite(area)) continue;
            const MaterialTexture& use = scene.materials[material].emissive_texture;
            const std::vector<glm::vec2>& uvs = use.uv_set == 0 ? assembly.uvs : assembly.more_uvs[use.uv_set - 1];
            glm::dvec2 places[3] = {};
            for (int k = 0; k < 3 && use; k++) places[k] = glm::dvec2(use.place(uvs[corners[k]]));
            powers.push_back(area * emission.at(material, places));
            emitters.push_back({i, t, instance.first_id + assembly.ids[t], 0, 0});
        }
    }
    const double sum = std::accumulate(powers.begin(), powers.end(), 0.0);
    const std::vector<float> cumulative = cumulative_shares(powers);
    for (size_t k = 0; k < emitters.size(); k++) {
        emitters[k].probability = float(powers[k] / sum);
        emitters[k].cumulative = cumulative[k];
    }
    return emitters;
}

}  // namespace peelray
