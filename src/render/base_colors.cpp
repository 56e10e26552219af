#include "render/base_colors.h"

#include <algorithm>
#include <cmath>

#include "common/material.h"
#include "render/fresnel_fit.h"
#include "scene/sidedness.h"

namespace peelray {
namespace {

/// What the dielectric part reflects: by its index alone, or as KHR_materials_specular says.
void set_reflectance(GpuMaterial& m, const Material& material) {
    const bool infinite = material.ior == 0;
    m.ior = infinite ? 1 : std::max(material.ior, 1.0f);  // nothing gets into what reflects all
    const double root = (m.ior - 1.0) / (m.ior + 1.0), f0 = infinite ? 1 : root * root;
    m.f0 = glm::min(float(f0) * material.specular_color, glm::vec3(1)) * material.specular;
    m.f90 = material.specular;
    if (infinite || material.specular != 1 || material.specular_color != glm::vec3(1)) {
        m.flags |= MATERIAL_SCHLICK;
    } else {
        const glm::vec4 fit = fresnel_fit(m.ior);
        m.f0 = glm::vec3(fit.x);
        m.fresnel_fit = glm::vec3(fit.y, fit.z, fit.w);
    }
}

GpuMaterial gpu_material(const Material& material, bool colored) {
    GpuMaterial m{};
    m.base_color = material.base_color;
    m.metallic = material.metallic;
    m.emissive = material.emissive;
    m.roughness = material.roughness;
    m.transmission = material.transmission;
    m.texture = material.base_color_texture;
    m.flags = (material.thickness <= 0 ? MATERIAL_THIN : 0u) | (material.unlit ? MATERIAL_UNLIT : 0u) |
              (colored ? MATERIAL_COLORED : 0u) | (is_single_sided(material) ? MATERIAL_SINGLE_SIDED : 0u);
    set_reflectance(m, material);
    m.thickness = material.thickness;
    m.alpha = material.alpha;
    m.alpha_cutoff = material.alpha_cutoff;
    // Beer and Lambert: white becomes attenuation_color after attenuation_distance (KHR_materials_volume).
    if (std::isfinite(material.attenuation_distance) && material.attenuation_distance > 0)
        m.absorption =
            -glm::log(glm::max(material.attenuation_color, glm::vec3(1e-6f))) / material.attenuation_distance;
    return m;
}

}  // namespace

BaseColorBuffers upload_base_colors(Device& device, Commands& commands, const Scene& scene, const Assembly& assembly) {
    std::vector<GpuMaterial> materials;
    for (const Material& material : scene.materials)
        materials.push_back(gpu_material(material, !assembly.colors.empty()));
    std::vector<GpuTexture> infos;
    std::vector<uint32_t> texels;
    for (const Texture& texture : scene.textures) {
        const uint32_t flags = uint32_t(texture.wrap_u) | uint32_t(texture.wrap_v) << 2 | (texture.nearest ? 16u : 0u);
        infos.push_back({uint32_t(texels.size()), texture.width, texture.height, flags});
        texels.insert(texels.end(), texture.texels.begin(), texture.texels.end());
    }
    return {upload(device, commands, "materials", materials),
            upload(device, commands, "texture table", infos),
            upload(device, commands, "textures", texels),
            upload(device, commands, "texture coordinates", assembly.uvs),
            upload(device, commands, "vertex colours", assembly.colors),
            upload(device, commands, "triangle materials", assembly.materials)};
}

}  // namespace peelray
