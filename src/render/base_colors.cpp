#include "render/base_colors.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <deque>
#include <map>

#include "base/error.h"
#include "common/material.h"
#include "path/shading_numbers.h"
#include "render/fresnel_fit.h"
#include "scene/mipmaps.h"
#include "scene/picture.h"
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
    if (infinite || material.specular != 1 || material.specular_color != glm::vec3(1) || material.specular_texture ||
        material.specular_color_texture) {
        m.flags |= MATERIAL_SCHLICK;
        m.fresnel_fit = float(f0) * material.specular_color;
    } else {
        const glm::vec4 fit = fresnel_fit(m.ior);
        m.f0 = glm::vec3(fit.x);
        m.fresnel_fit = glm::vec3(fit.y, fit.z, fit.w);
    }
}

/// What few materials have.
void set_rare_parts(GpuMaterial& m, const Material& material) {
    m.sheen_color = material.sheen_color;
    m.sheen_roughness = material.sheen_roughness;
    m.iridescence = material.iridescence;
    m.film_ior = std::max(material.film_ior, 1.0f);
    m.film_most = material.film_most;
    m.film_least = material.film_thickness_texture ? material.film_least : material.film_most;
    m.anisotropy = material.anisotropy;
    m.anisotropy_along = {std::cos(material.anisotropy_rotation), std::sin(material.anisotropy_rotation)};
    const bool disperses = transmits(material) && material.thickness > 0 && material.ior != 0;  // volumes alone
    m.spread = disperses ? float(DISPERSION_SPREAD) * material.dispersion * (std::max(material.ior, 1.0f) - 1) : 0;
    m.diffuse_transmission = material.diffuse_transmission;
    m.diffuse_transmission_color = material.diffuse_transmission_color;
}

/// MATERIALS_* of one material, those of textures excepted.
uint32_t material_kinds(const Material& material, const GpuMaterial& m) {
    uint32_t kinds = m.flags & MATERIAL_SCHLICK ? MATERIALS_SPECIFIED : 0;
    if (material.blended) kinds |= MATERIALS_BLENDED;
    if (material.clearcoat > 0) kinds |= MATERIALS_COATED;
    if (material.catcher) kinds |= MATERIALS_CATCHING;
    if (material.sheen_color != glm::vec3(0)) kinds |= MATERIALS_SHEEN;
    if (material.iridescence > 0) kinds |= MATERIALS_FILMED;
    if (material.anisotropy > 0) kinds |= MATERIALS_STRETCHED;
    if (m.spread > 0) kinds |= MATERIALS_DISPERSIVE;
    if (material.diffuse_transmission > 0) kinds |= MATERIALS_SEEPING;
    if (transmits(material) && (material.roughness >= MIRROR_ROUGHNESS || material.anisotropy > 0))
        kinds |= MATERIALS_FROSTED;
    return kinds;
}

GpuMaterial gpu_material(const Material& material, bool colored) {
    GpuMaterial m{};
    m.base_color = material.base_color;
    m.metallic = material.metallic;
    m.emissive = material.emissive;
    m.roughness = material.roughness;
    m.transmission = material.transmission;
    m.normal_scale = material.normal_scale;
    m.occlusion_strength = material.occlusion_strength;
    m.clearcoat = material.clearcoat;
    m.coat_roughness = material.coat_roughness;
    m.coat_normal_scale = material.coat_normal_scale;
    set_rare_parts(m, material);
    m.flags = (material.thickness <= 0 ? MATERIAL_THIN : 0u) | (material.unlit ? MATERIAL_UNLIT : 0u) |
              (colored ? MATERIAL_COLORED : 0u) | (material.blended ? MATERIAL_BLENDED : 0u) |
              (is_single_sided(material) ? MATERIAL_SINGLE_SIDED : 0u) | (material.catcher ? MATERIAL_CATCHER : 0u);
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

/// What a device can hold of all textures, in rows of texels.
uint64_t most_rows(const Device& device) {
    constexpr uint64_t layer_rows = uint64_t(1) << (TEXEL_LAYER_BITS - TEXEL_ROW_BITS);
    constexpr uint64_t addressed = (uint64_t(1) << 32) >> TEXEL_ROW_BITS;
    return std::min<uint64_t>(addressed, device.limits().maxImageArrayLayers * layer_rows);
}

/// The textures that materials use, each from the start of a row on.
class TextureStore {
  public:
    explicit TextureStore(const Scene& scene) : scene_(scene) {}

    /// An entry of the table for what a material uses; -1: it uses none. `is_data`: not encoded as sRGB; `levels`: with
    /// those that serve where the texture is made smaller.
    int add(const MaterialTexture& use, bool is_data, bool levels, uint64_t vertices) {
        if (!use) return -1;
        const Texture& texture = scene_.textures[size_t(use.texture)];
        const auto [first, added] = first_.try_emplace(use.texture, 0);
        if (added) first->second = keep(words(texture));
        GpuTexture entry{first->second, texture.width, texture.height, 0};
        entry.flags = uint32_t(texture.wrap_u) | uint32_t(texture.wrap_v) << 2 | (texture.nearest ? USE_NEAREST : 0u) |
                      (is_data ? USE_DATA : 0u) | (texture.deep_texels.empty() ? 0u : USE_DEEP) |
                      (texture.min_nearest ? USE_MIN_NEAREST : 0u);
        levels &= texture.mipmaps != Texture::Mipmaps::none && texture.width * uint64_t(texture.height) > 1;
        if (levels) {
            const auto [smaller, made] = smaller_.try_emplace({use.texture, is_data}, 0);
            if (made) smaller->second = keep_levels(texture, is_data);
            entry.smaller = smaller->second;
            entry.flags |= texture.mipmaps == Texture::Mipmaps::linear ? USE_LEVELS | USE_BETWEEN : USE_LEVELS;
        }
        entry.first_uv = uint32_t(use.uv_set * vertices);
        entry.u_axis = use.uv_matrix[0];
        entry.v_axis = use.uv_matrix[1];
        entry.uv_offset = use.uv_offset;
        if (use.uv_matrix != glm::mat2(1) || use.uv_offset != glm::vec2(0)) entry.flags |= USE_MOVED;
        const auto same = [&](const GpuTexture& other) { return std::memcmp(&entry, &other, sizeof entry) == 0; };
        const auto index = std::find_if(table.begin(), table.end(), same) - table.begin();
        if (size_t(index) == table.size()) table.push_back(entry);
        return int(index);
    }

    Image2D upload(Device& device, Commands& commands) const {
        constexpr uint64_t width = 1u << TEXEL_ROW_BITS, layer_rows = 1u << (TEXEL_LAYER_BITS - TEXEL_ROW_BITS);
        if (row_count_ == 0) return {};
        if (row_count_ > most_rows(device))
            fail(
                "the textures and their smaller levels take {} million texels, more than the {} million that the "
                "device '{}' holds: make them smaller",
                row_count_ * width / 1'000'000, most_rows(device) * width / 1'000'000, device.info().name);
        Image2D image(device, "textures", uint32_t(width), uint32_t(std::min(row_count_, layer_rows)),
                      VK_FORMAT_R32_UINT, VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT,
                      VK_IMAGE_ASPECT_COLOR_BIT, uint32_t((row_count_ + layer_rows - 1) / layer_rows), true);
        for (const Kept& kept : kept_) commands.upload(image, kept.words, kept.row);
        return image;
    }

    std::vector<GpuTexture> table;

  private:
    static std::span<const uint32_t> words(const Texture& texture) {
        if (texture.deep_texels.empty()) return texture.texels;
        return {reinterpret_cast<const uint32_t*>(texture.deep_texels.data()), 2 * texture.deep_texels.size()};
    }

    /// Words that lie in the rows from `row` on; of the scene's textures or of levels that were made here.
    struct Kept {
        std::span<const uint32_t> words;
        uint64_t row;
    };

    /// Returns the place of the first word.
    uint32_t keep(std::span<const uint32_t> list) {
        const uint64_t row = row_count_;
        kept_.push_back({list, row});
        row_count_ += (list.size() + (1u << TEXEL_ROW_BITS) - 1) >> TEXEL_ROW_BITS;
        return uint32_t(row << TEXEL_ROW_BITS);
    }

    /// Levels 1, 2, … one after the other.
    uint32_t keep_levels(const Texture& texture, bool is_data) {
        std::vector<uint32_t>& all = levels_.emplace_back();
        for (const Texture& level : make_mipmaps(texture, is_data)) {
            const std::span<const uint32_t> list = words(level);
            all.insert(all.end(), list.begin(), list.end());
        }
        return keep(all);
    }

    const Scene& scene_;
    std::map<int, uint32_t> first_;                     ///< by texture
    std::map<std::pair<int, bool>, uint32_t> smaller_;  ///< by texture and whether it is data
    std::deque<std::vector<uint32_t>> levels_;          ///< a deque: entries stay where they are
    std::vector<Kept> kept_;
    uint64_t row_count_ = 0;
};

/// Does it matter how large the texture is seen?
bool is_filtered(const GpuTexture& texture) {
    return texture.flags & USE_LEVELS || !(texture.flags & USE_NEAREST) != !(texture.flags & USE_MIN_NEAREST);
}

/// Texture coordinates, set after set, then the tangents, in one buffer: passes that shade bind as many as any device
/// allows.
Buffer upload_uvs(Device& device, Commands& commands, const Assembly& assembly) {
    const uint64_t bytes = assembly.uvs.size() * sizeof(glm::vec2), sets = 1 + assembly.more_uvs.size();
    Buffer buffer(device, "texture coordinates",
                  std::max<uint64_t>(sets * bytes + assembly.tangents.size() * sizeof(glm::vec4), sizeof(glm::vec2)));
    const auto put = [&](const auto& list, uint64_t offset) {
        if (!list.empty()) commands.upload(buffer, std::span(list), offset);
    };
    put(assembly.uvs, 0);
    for (size_t set = 0; set < assembly.more_uvs.size(); set++) put(assembly.more_uvs[set], bytes * (1 + set));
    put(assembly.tangents, bytes * sets);
    return buffer;
}

}  // namespace

std::vector<bool> used_materials(const Scene& scene, const Assembly& assembly) {
    std::vector<bool> used(scene.materials.size(), false);
    for (uint32_t material : assembly.materials) used[material] = true;
    return used;
}

BaseColorBuffers upload_base_colors(Device& device, Commands& commands, const Scene& scene, const Assembly& assembly,
                                    const std::vector<bool>& used, MaterialsFor purpose) {
    const bool shades = purpose == MaterialsFor::shading;
    BaseColorBuffers out;
    out.first_tangent = uint32_t(assembly.uvs.size() * (1 + assembly.more_uvs.size()));
    TextureStore textures(scene);
    std::vector<GpuMaterial> materials;
    for (size_t i = 0; i < scene.materials.size(); i++) {
        const Material& material = scene.materials[i];
        GpuMaterial m = gpu_material(material, !assembly.colors.empty());
        m.first_tangent = out.first_tangent;
        if (assembly.tangents.empty()) m.anisotropy = 0;  // there is nothing to read a direction from
        for (int k = 0; k < TEXTURE_USES; k++) {
            const MaterialTexture& use = material.*material_textures[size_t(k)];
            const bool read = used[i] && (shades || (k == TEXTURE_BASE_COLOR && material.alpha_cutoff > 0));
            const bool is_data = !is_color(material_textures[size_t(k)]);
            m.textures[k] = read ? textures.add(use, is_data, shades, assembly.uvs.size()) : -1;
            m.channels[k >> 4] |= use.channel << 2 * (k & 15);
            if (m.textures[k] < 0 || k == TEXTURE_BASE_COLOR) continue;
            out.kinds |= MATERIALS_TEXTURED;
            if (!TEXTURE_TURNS(k)) m.flags |= MATERIAL_TEXTURED;
        }
        if (used[i]) out.kinds |= material_kinds(material, m);
        materials.push_back(m);
    }
    if (std::ranges::any_of(textures.table, is_filtered)) out.kinds |= MATERIALS_FILTERED;
    out.materials = upload(device, commands, "materials", materials);
    out.texture_infos = upload(device, commands, "texture table", textures.table);
    out.texels = textures.upload(device, commands);
    out.uvs = upload_uvs(device, commands, assembly);
    out.colors = upload(device, commands, "vertex colours", assembly.colors);
    out.triangle_materials = upload(device, commands, "triangle materials", assembly.materials);
    return out;
}

}  // namespace peelray
