#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "loaders/gltf.h"
#include "loaders/images.h"
#include "scene/media.h"
#include "scene/sampling.h"
#include "scene/tangents.h"

namespace peelray {

namespace {

float unit(double value) {
    return static_cast<float>(std::clamp(value, 0.0, 1.0));
}

glm::vec3 to_vec3(const std::vector<double>& v) {
    return {v[0], v[1], v[2]};
}

/// None: unknown.
std::optional<Texture::Wrap> wrap_mode(int mode) {
    switch (mode) {
        case TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE:
            return Texture::Wrap::clamp;
        case TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT:
            return Texture::Wrap::mirror;
        case TINYGLTF_TEXTURE_WRAP_REPEAT:
            return Texture::Wrap::repeat;
        default:
            return std::nullopt;
    }
}

/// Where the file leaves the choice: bilinear, and between levels. False: something in it is unknown.
bool set_filters(Texture& texture, const tinygltf::Sampler& sampler) {
    const int large = sampler.magFilter, small = sampler.minFilter;
    texture.nearest = large == TINYGLTF_TEXTURE_FILTER_NEAREST;
    texture.min_nearest = small == TINYGLTF_TEXTURE_FILTER_NEAREST ||
                          small == TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_NEAREST ||
                          small == TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_LINEAR;
    if (small == TINYGLTF_TEXTURE_FILTER_NEAREST || small == TINYGLTF_TEXTURE_FILTER_LINEAR)
        texture.mipmaps = Texture::Mipmaps::none;
    else if (small == TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_NEAREST ||
             small == TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_NEAREST)
        texture.mipmaps = Texture::Mipmaps::nearest;
    const bool knows_large = large == -1 || texture.nearest || large == TINYGLTF_TEXTURE_FILTER_LINEAR;
    const bool knows_small = small == -1 || small == TINYGLTF_TEXTURE_FILTER_NEAREST ||
                             small == TINYGLTF_TEXTURE_FILTER_LINEAR ||
                             (small >= TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_NEAREST &&
                              small <= TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_LINEAR);
    return knows_large && knows_small;
}

/// An extension's object; tinygltf's null value, which has no members, where it is missing.
const tinygltf::Value& extension(const tinygltf::ExtensionMap& extensions, const char* name) {
    static const tinygltf::Value none;
    const auto found = extensions.find(name);
    return found == extensions.end() ? none : found->second;
}

double number(const tinygltf::Value& object, const char* key, double missing) {
    return object.Has(key) ? object.Get(key).GetNumberAsDouble() : missing;
}

template <typename Vector>
Vector vector(const tinygltf::Value& object, const char* key, Vector missing) {
    if (object.Has(key))
        for (int i = 0; i < Vector::length(); ++i)
            missing[i] = static_cast<float>(object.Get(key).Get(i).GetNumberAsDouble());
    return missing;
}

/// A textureInfo, whoever gives it.
struct TextureInfo {
    int index = -1;
    double set = 0;
    const tinygltf::Value* transform = nullptr;

    /// tinygltf's TextureInfo, NormalTextureInfo and OcclusionTextureInfo have the same members.
    template <typename Info>
    static TextureInfo of(const Info& info) {
        return {info.index, double(info.texCoord), &extension(info.extensions, "KHR_texture_transform")};
    }
    /// An extension's member; none where it is missing.
    static TextureInfo of(const tinygltf::Value& object, const char* key) {
        if (!object.Has(key)) return {};
        const tinygltf::Value& info = object.Get(key);
        const tinygltf::Value& extensions = info.Get("extensions");
        return {info.Get("index").GetNumberAsInt(), number(info, "texCoord", 0),
                extensions.Has("KHR_texture_transform") ? &extensions.Get("KHR_texture_transform") : nullptr};
    }
};

class MaterialReader {
  public:
    MaterialReader(GltfLoader& loader, size_t index)
        : loader_(loader), model_(loader.file.model()), from_(model_.materials[index]), index_(index) {}

    void read() {
        material_.name = from_.name;
        material_.double_sided = from_.doubleSided;
        const tinygltf::Value& glossy = extension(from_.extensions, "KHR_materials_pbrSpecularGlossiness");
        glossy.IsObject() ? read_specular_glossiness(glossy) : read_metallic_roughness();
        read_emission();
        read_transmission();
        if (!glossy.IsObject()) read_reflectance();
        read_clearcoat();
        read_sheen();
        read_iridescence();
        read_dispersion();
        read_diffuse_transmission();
        material_.unlit = from_.extensions.count("KHR_materials_unlit") > 0;
        material_.normal_texture = use(TextureInfo::of(from_.normalTexture));
        material_.normal_scale = static_cast<float>(from_.normalTexture.scale);
        material_.occlusion_texture = use(TextureInfo::of(from_.occlusionTexture));
        material_.occlusion_strength = unit(from_.occlusionTexture.strength);
        read_anisotropy();
        read_alpha_mode();
        loader_.scene.materials.push_back(std::move(material_));
        loader_.uv_sets.push_back(std::move(uv_sets_));
    }

  private:
    void read_metallic_roughness() {
        const tinygltf::PbrMetallicRoughness& pbr = from_.pbrMetallicRoughness;
        material_.base_color = glm::clamp(to_vec3(pbr.baseColorFactor), 0.f, 1.f);
        material_.alpha = unit(pbr.baseColorFactor[3]);
        material_.metallic = unit(pbr.metallicFactor);
        material_.roughness = unit(pbr.roughnessFactor);
        material_.base_color_texture = use(TextureInfo::of(pbr.baseColorTexture), 0, true);
        material_.roughness_texture = use(TextureInfo::of(pbr.metallicRoughnessTexture), 1);
        material_.metallic_texture = material_.roughness_texture;
        material_.metallic_texture.channel = 2;
    }

    /// No metal: the reflection at normal incidence is stated, whatever the index of refraction.
    void read_specular_glossiness(const tinygltf::Value& from) {
        const glm::vec4 diffuse = glm::clamp(vector(from, "diffuseFactor", glm::vec4(1)), 0.f, 1.f);
        material_.base_color = glm::vec3(diffuse);
        material_.alpha = diffuse.w;
        material_.base_color_texture = use(TextureInfo::of(from, "diffuseTexture"), 0, true);
        material_.ior = 0;
        material_.specular_color = glm::clamp(vector(from, "specularFactor", glm::vec3(1)), 0.f, 1.f);
        material_.specular_color_texture = use(TextureInfo::of(from, "specularGlossinessTexture"));
        const float glossiness = unit(number(from, "glossinessFactor", 1));
        material_.roughness = 1 - glossiness;
        material_.roughness_texture = use(TextureInfo::of(from, "specularGlossinessTexture"), 3);
        if (!material_.roughness_texture) return;
        material_.roughness = 1;
        material_.roughness_texture.texture = rough_texture(material_.roughness_texture.texture, glossiness);
    }

    /// The texture whose alpha is what a texture's alpha times `glossiness` leaves of 1.
    int rough_texture(int texture, float glossiness) {
        const auto [entry, added] =
            loader_.rough_textures.try_emplace({texture, glossiness}, int(loader_.scene.textures.size()));
        if (!added) return entry->second;
        Texture rough = loader_.scene.textures[static_cast<size_t>(texture)];
        const auto left = [&](uint64_t alpha, uint64_t most) {
            return static_cast<uint64_t>(std::lround(double(most) - glossiness * double(alpha)));
        };
        for (uint32_t& t : rough.texels) t = (t & 0xffffff) | static_cast<uint32_t>(left(t >> 24, 255)) << 24;
        for (uint64_t& t : rough.deep_texels) t = (t & 0xffffffffffff) | left(t >> 48, 65535) << 48;
        loader_.scene.textures.push_back(std::move(rough));
        return entry->second;
    }

    void read_alpha_mode() {
        const std::string& mode = from_.alphaMode;
        if (mode != "OPAQUE" && mode != "MASK" && mode != "BLEND")
            fail("{}: alphaMode \"{}\" is unknown; it must be OPAQUE, MASK or BLEND",
                 loader_.file.where("materials", index_), printable(mode, 20));
        if (from_.alphaCutoff < 0)
            fail("{}: alphaCutoff {} must not be below 0", loader_.file.where("materials", index_), from_.alphaCutoff);
        if (mode == "MASK") material_.alpha_cutoff = static_cast<float>(from_.alphaCutoff);
        if (mode == "BLEND") read_blending();
    }

    /// Coverage, but where nothing in the file says less than 1. Texels of which nothing is there are holes: rays need
    /// not stop at them.
    void read_blending() {
        const MaterialTexture& texture = material_.base_color_texture;
        const double least =
            texture ? least_value(loader_.scene.textures[static_cast<size_t>(texture.texture)], 3) : 1.0;
        const auto has_colors = [](const tinygltf::Mesh& mesh) {
            return std::ranges::any_of(mesh.primitives, [](const auto& p) { return p.attributes.contains("COLOR_0"); });
        };
        material_.blended = material_.alpha * least < 1 || std::ranges::any_of(model_.meshes, has_colors);
        if (fills_volume(material_) && material_.blended) {
            material_.blended = false;
            ++loader_.ignored["alphaMode BLEND of {} material{|s} that {bounds|bound} a refracting volume ignored"];
        }
        if (material_.blended && material_.alpha * least * 255 < 0.5) material_.alpha_cutoff = 0.5f / 255;
    }

    void read_emission() {
        const tinygltf::Value& strength = extension(from_.extensions, "KHR_materials_emissive_strength");
        material_.emissive =
            to_vec3(from_.emissiveFactor) * static_cast<float>(number(strength, "emissiveStrength", 1));
        material_.emissive = glm::max(material_.emissive, glm::vec3(0));
        material_.emissive_texture = use(TextureInfo::of(from_.emissiveTexture));
    }

    void read_clearcoat() {
        const tinygltf::Value& coat = extension(from_.extensions, "KHR_materials_clearcoat");
        material_.clearcoat = unit(number(coat, "clearcoatFactor", 0));
        material_.coat_roughness = unit(number(coat, "clearcoatRoughnessFactor", 0));
        if (material_.clearcoat == 0) return;
        material_.clearcoat_texture = use(TextureInfo::of(coat, "clearcoatTexture"));
        material_.coat_roughness_texture = use(TextureInfo::of(coat, "clearcoatRoughnessTexture"), 1);
        material_.coat_normal_texture = use(TextureInfo::of(coat, "clearcoatNormalTexture"));
        if (material_.coat_normal_texture)
            material_.coat_normal_scale = static_cast<float>(number(coat.Get("clearcoatNormalTexture"), "scale", 1));
    }

    void read_sheen() {
        const tinygltf::Value& sheen = extension(from_.extensions, "KHR_materials_sheen");
        material_.sheen_color = glm::clamp(vector(sheen, "sheenColorFactor", glm::vec3(0)), 0.f, 1.f);
        material_.sheen_roughness = unit(number(sheen, "sheenRoughnessFactor", 0));
        if (material_.sheen_color == glm::vec3(0)) return;
        material_.sheen_color_texture = use(TextureInfo::of(sheen, "sheenColorTexture"));
        material_.sheen_roughness_texture = use(TextureInfo::of(sheen, "sheenRoughnessTexture"), 3);
    }

    /// The least thickness may be above the most: then the texture runs the other way.
    void read_iridescence() {
        const tinygltf::Value& film = extension(from_.extensions, "KHR_materials_iridescence");
        // Beyond these numbers it is no thin film, and rounding decides what is seen of it.
        constexpr double most_ior = 1e6, most_thickness = 1e5;
        const auto thickness = [&](const char* key, double missing) {
            return static_cast<float>(std::clamp(number(film, key, missing), 0.0, most_thickness));
        };
        material_.iridescence = unit(number(film, "iridescenceFactor", 0));
        material_.film_ior = static_cast<float>(std::clamp(number(film, "iridescenceIor", 1.3), 1.0, most_ior));
        material_.film_least = thickness("iridescenceThicknessMinimum", 100);
        material_.film_most = thickness("iridescenceThicknessMaximum", 400);
        if (material_.iridescence == 0) return;
        material_.iridescence_texture = use(TextureInfo::of(film, "iridescenceTexture"));
        material_.film_thickness_texture = use(TextureInfo::of(film, "iridescenceThicknessTexture"), 1);
    }

    /// Infinite indices of refraction have none. At 40 red is no longer bent.
    void read_dispersion() {
        const tinygltf::Value& dispersion = extension(from_.extensions, "KHR_materials_dispersion");
        constexpr double most = 1000;
        if (material_.ior > 0)
            material_.dispersion = static_cast<float>(std::clamp(number(dispersion, "dispersion", 0), 0.0, most));
    }

    void read_diffuse_transmission() {
        const tinygltf::Value& from = extension(from_.extensions, "KHR_materials_diffuse_transmission");
        material_.diffuse_transmission = unit(number(from, "diffuseTransmissionFactor", 0));
        material_.diffuse_transmission_color =
            glm::clamp(vector(from, "diffuseTransmissionColorFactor", glm::vec3(1)), 0.f, 1.f);
        if (material_.diffuse_transmission == 0) return;
        material_.diffuse_transmission_texture = use(TextureInfo::of(from, "diffuseTransmissionTexture"), 3);
        material_.diffuse_transmission_color_texture = use(TextureInfo::of(from, "diffuseTransmissionColorTexture"));
    }

    /// After the textures of normals: where neither they nor its own say which coordinates tangents follow, TEXCOORD_0
    /// do.
    void read_anisotropy() {
        const tinygltf::Value& anisotropy = extension(from_.extensions, "KHR_materials_anisotropy");
        material_.anisotropy = unit(number(anisotropy, "anisotropyStrength", 0));
        if (material_.anisotropy == 0) return;
        constexpr double turn = 2 * 3.14159265358979323846;
        material_.anisotropy_rotation =
            static_cast<float>(std::remainder(number(anisotropy, "anisotropyRotation", 0), turn));
        material_.anisotropy_texture = use(TextureInfo::of(anisotropy, "anisotropyTexture"));
        if (!tangent_texture(material_)) material_.anisotropy_texture.uv_set = uv_set(0);
    }

    void read_transmission() {
        const tinygltf::Value& transmission = extension(from_.extensions, "KHR_materials_transmission");
        const tinygltf::Value& volume = extension(from_.extensions, "KHR_materials_volume");
        material_.transmission = unit(number(transmission, "transmissionFactor", 0));
        material_.transmission_texture = use(TextureInfo::of(transmission, "transmissionTexture"));
        material_.thickness = std::max(0.f, static_cast<float>(number(volume, "thicknessFactor", 0)));
        material_.thickness_texture = use(TextureInfo::of(volume, "thicknessTexture"), 1);
        material_.attenuation_color = glm::clamp(vector(volume, "attenuationColor", glm::vec3(1)), 0.f, 1.f);
        if (volume.Has("attenuationDistance")) {
            const double distance = number(volume, "attenuationDistance", 0);
            if (distance <= 0)
                fail("{}: attenuationDistance {} must be above 0", loader_.file.where("materials", index_), distance);
            material_.attenuation_distance = static_cast<float>(distance);
        }
    }

    void read_reflectance() {
        const double ior = number(extension(from_.extensions, "KHR_materials_ior"), "ior", 1.5);
        // 0 stands for an infinite index; what comes near to that is the same.
        material_.ior = ior == 0 || ior > 1e6 ? 0.f : static_cast<float>(std::max(1.0, ior));
        if (ior < 1 && ior != 0)
            ++loader_
                  .ignored["{} {index|indices} of refraction below 1, other than 0, drawn with 1 (VALUE_NOT_IN_RANGE)"];
        const tinygltf::Value& specular = extension(from_.extensions, "KHR_materials_specular");
        material_.specular = unit(number(specular, "specularFactor", 1));
        material_.specular_color = glm::max(vector(specular, "specularColorFactor", glm::vec3(1)), glm::vec3(0));
        material_.specular_texture = use(TextureInfo::of(specular, "specularTexture"), 3);
        material_.specular_color_texture = use(TextureInfo::of(specular, "specularColorTexture"));
    }

    /// Does `read`, unless the image is damaged, or it shows that it is: that is noted, and false.
    template <typename Read>
    bool unless_damaged(int image, Read read) {
        if (loader_.damaged_images.contains(image)) return false;
        try {
            read();
            return true;
        } catch (const Error& error) {
            loader_.damaged_images.emplace(image, error.text());
            return false;
        }
    }

    /// A texture and where its coordinates come from; none where its image cannot be had. `channel`: of a single
    /// number.
    MaterialTexture use(const TextureInfo& info, uint32_t channel = 0, bool is_base_color = false) {
        if (info.index < 0) return {};
        const std::optional<int> image = image_if_there(info.index, is_base_color);
        if (!image) return {};
        MaterialTexture out(texture_id(*image, info.index));
        if (!out) return out;
        out.channel = channel;
        static const tinygltf::Value none;
        const tinygltf::Value& transform = info.transform ? *info.transform : none;
        out.uv_set = uv_set(static_cast<uint32_t>(number(transform, "texCoord", info.set)));
        const glm::vec2 scale = vector(transform, "scale", glm::vec2(1));
        const auto rotation = static_cast<float>(number(transform, "rotation", 0));
        const float c = std::cos(rotation), s = std::sin(rotation);
        out.uv_matrix = glm::mat2(c * scale.x, -s * scale.x, s * scale.y, c * scale.y);
        out.uv_offset = vector(transform, "offset", glm::vec2(0));
        return out;
    }

    /// The primitives' set of texture coordinates that TEXCOORD_`set` becomes.
    uint32_t uv_set(uint32_t set) {
        const auto found = std::find(uv_sets_.begin(), uv_sets_.end(), set);
        const auto index = static_cast<uint32_t>(found - uv_sets_.begin());
        if (found == uv_sets_.end()) uv_sets_.push_back(set);
        return index;
    }

    /// The image that a texture shows; none (with a note) where no source is known.
    std::optional<int> image_of(int texture) {
        const int image = model_.textures[static_cast<size_t>(texture)].source;
        if (image >= 0) return image;
        ++loader_.ignored["{} texture{|s} ignored that {names|name} no image, or only in an extension that is unknown"];
        return std::nullopt;
    }

    /// The same, and none (with a note) where the image cannot be had: a material has its factors, so that is no reason
    /// to give up.
    std::optional<int> image_if_there(int texture, bool is_base_color) {
        const std::optional<int> image = image_of(texture);
        if (!image) return image;
        if (loader_.file.is_image_missing(*image)) {
            ++loader_.ignored[is_base_color
                                  ? fmt::format(
                                        "{{}} base colour texture{{|s}} left out, the image file {} is missing: the "
                                        "factors are used",
                                        escaped(loader_.file.image_file(*image), 80))
                                  : "{} texture{|s} other than of the base colour left out, {its|their} image {file "
                                    "is|files are} missing"];
            return std::nullopt;
        }
        const char* type = nullptr;
        if (!unless_damaged(*image, [&] { type = foreign_image_type(loader_.file.image_bytes(*image)); }))
            return std::nullopt;
        if (!type) return image;
        ++loader_
              .ignored[fmt::format("{{}} texture{{|s}} left out, {{its image is|their images are}} of the type {}, "
                                   "which is not read: the factors are used",
                                   type)];
        return std::nullopt;
    }

    int texture_id(int image, int texture) {
        const int index = model_.textures[static_cast<size_t>(texture)].sampler;
        const tinygltf::Sampler sampler = index < 0 ? tinygltf::Sampler() : model_.samplers[static_cast<size_t>(index)];
        const auto known = [&](int mode) {
            const std::optional<Texture::Wrap> wrap = wrap_mode(mode);
            if (!wrap) ++loader_.ignored["{} unknown wrap mode{|s} read as REPEAT (VALUE_NOT_IN_LIST)"];
            return wrap.value_or(Texture::Wrap::repeat);
        };
        const Texture::Wrap u = known(sampler.wrapS), v = known(sampler.wrapT);
        const auto [entry, added] = loader_.texture_ids.try_emplace(
            {image, int(u), int(v), sampler.magFilter, sampler.minFilter}, int(loader_.scene.textures.size()));
        if (added) {
            const std::string& name = model_.images[static_cast<size_t>(image)].name;
            Texture decoded;
            if (!unless_damaged(image, [&] {
                    decoded = decode_image(loader_.file.image_bytes(image), where(image), Depth::as_stored);
                })) {
                entry->second = -1;
                return -1;
            }
            decoded.name = name.empty() ? loader_.file.image_file(image) : name;
            decoded.wrap_u = u;
            decoded.wrap_v = v;
            if (!set_filters(decoded, sampler))
                ++loader_.ignored["{} unknown filter{|s} of textures ignored (VALUE_NOT_IN_LIST)"];
            loader_.scene.textures.push_back(std::move(decoded));
        }
        return entry->second;
    }

    /// The place of an image in messages, with its file where it has one.
    std::string where(int image) const {
        const std::string place = loader_.file.where("images", static_cast<size_t>(image));
        const std::string name = loader_.file.image_file(image);
        return name.empty() ? place : fmt::format("{} ({})", place, printable(name, 80));
    }

    GltfLoader& loader_;
    const tinygltf::Model& model_;
    const tinygltf::Material& from_;
    const size_t index_;
    Material material_;
    std::vector<uint32_t> uv_sets_;  ///< the TEXCOORD_ of its textures, by first use
};

}  // namespace

uint32_t GltfLoader::unlit(uint32_t material) {
    if (scene.materials[material].unlit) return material;
    const auto [copy, added] = unlit_copies.try_emplace(material, uint32_t(scene.materials.size()));
    if (added) {
        Material same = scene.materials[material];
        same.unlit = true;
        scene.materials.push_back(std::move(same));
        uv_sets.push_back(std::vector<uint32_t>(uv_sets[material]));
    }
    return copy->second;
}

void GltfLoader::read_materials() {
    for (size_t i = 0; i < file.model().materials.size(); ++i) MaterialReader(*this, i).read();
    Material fallback;
    fallback.name = "default";
    fallback.metallic = 1;  // the format's defaults
    fallback.double_sided = false;
    scene.materials.push_back(std::move(fallback));
    uv_sets.emplace_back();
}

}  // namespace peelray
