#include <algorithm>

#include "scene/gltf.h"
#include "scene/images.h"

namespace peelray {

namespace {

glm::vec3 to_vec3(const std::array<float, 3>& v) {
    return {v[0], v[1], v[2]};
}

float unit(double value) {
    return static_cast<float>(std::clamp(value, 0.0, 1.0));
}

Texture::Wrap wrap_mode(const JsonView& sampler, const char* key) {
    switch (sampler.count(key, 10497)) {
        case 33071:
            return Texture::Wrap::clamp;
        case 33648:
            return Texture::Wrap::mirror;
        case 10497:
            return Texture::Wrap::repeat;
        default:
            fail("{}.{}: {} is no wrap mode", sampler.where(), key, sampler.count(key, 0));
    }
}

class MaterialReader {
  public:
    MaterialReader(GltfLoader& loader, const JsonView& json)
        : loader_(loader), json_(json), extensions_(json.object("extensions")) {}

    void read() {
        material_.name = json_.text("name", "");
        read_metallic_roughness();
        read_emission();
        read_transmission();
        material_.unlit = extensions_.has("KHR_materials_unlit");
        ignore(json_, "normalTexture", "{} normal maps ignored");
        ignore(json_, "occlusionTexture", "{} occlusion textures ignored");
        const std::string mode = json_.text("alphaMode", "OPAQUE");
        if (mode == "MASK") ++loader_.ignored["{} materials with alphaMode MASK drawn opaque"];
        if (mode == "BLEND") ++loader_.ignored["{} materials with alphaMode BLEND drawn opaque"];
        loader_.scene.materials.push_back(std::move(material_));
        loader_.uv_sources.push_back(uv_);
    }

  private:
    void read_metallic_roughness() {
        const JsonView pbr = json_.object("pbrMetallicRoughness");
        const auto color = pbr.vector<4>("baseColorFactor", {1, 1, 1, 1});
        material_.base_color = glm::clamp(glm::vec3(color[0], color[1], color[2]), 0.f, 1.f);
        material_.alpha = unit(color[3]);
        material_.metallic = unit(pbr.number("metallicFactor", 1));
        material_.roughness = unit(pbr.number("roughnessFactor", 1));
        if (pbr.has("baseColorTexture")) read_base_color(pbr.object("baseColorTexture"));
        if (const auto mean = mean_of(pbr, "metallicRoughnessTexture", false)) {
            material_.roughness *= mean->y;
            material_.metallic *= mean->z;
            ++loader_.ignored["{} metallic-roughness textures replaced by their mean"];
        }
    }

    void read_emission() {
        const JsonView strength = extensions_.object("KHR_materials_emissive_strength");
        material_.emissive = to_vec3(json_.vector<3>("emissiveFactor", {0, 0, 0})) *
                             static_cast<float>(strength.number("emissiveStrength", 1));
        material_.emissive = glm::max(material_.emissive, glm::vec3(0));
        if (const auto mean = mean_of(json_, "emissiveTexture", true)) {
            material_.emissive *= glm::vec3(*mean);
            ++loader_.ignored["{} emissive textures replaced by their mean"];
        }
    }

    void read_transmission() {
        const JsonView transmission = extensions_.object("KHR_materials_transmission"),
                       volume = extensions_.object("KHR_materials_volume");
        material_.transmission = unit(transmission.number("transmissionFactor", 0));
        if (const auto mean = mean_of(transmission, "transmissionTexture", false)) {
            material_.transmission *= mean->x;
            ++loader_.ignored["{} transmission textures replaced by their mean"];
        }
        // The extension allows 0 for "reflects everything", which no ray can be bent by; below 1 there is no such
        // medium.
        material_.ior = std::max(1.f, static_cast<float>(extensions_.object("KHR_materials_ior").number("ior", 1.5)));
        material_.thickness = std::max(0.f, static_cast<float>(volume.number("thicknessFactor", 0)));
        ignore(volume, "thicknessTexture", "{} thickness textures ignored");
        material_.attenuation_color = glm::clamp(to_vec3(volume.vector<3>("attenuationColor", {1, 1, 1})), 0.f, 1.f);
        if (volume.has("attenuationDistance")) {
            const double distance = volume.number("attenuationDistance", 0);
            if (distance <= 0) fail("{}.attenuationDistance: {} must be above 0", volume.where(), distance);
            material_.attenuation_distance = static_cast<float>(distance);
        }
    }

    void read_base_color(const JsonView& info) {
        const std::optional<uint32_t> image = image_of(info);
        uv_.set = static_cast<uint32_t>(std::min<uint64_t>(info.count("texCoord", 0), 1000));
        const JsonView transform = info.object("extensions").object("KHR_texture_transform");
        const auto offset = transform.vector<2>("offset", {0, 0}), scale = transform.vector<2>("scale", {1, 1});
        uv_.set = static_cast<uint32_t>(std::min<uint64_t>(transform.count("texCoord", uv_.set), 1000));
        uv_.offset = {offset[0], offset[1]};
        uv_.scale = {scale[0], scale[1]};
        uv_.rotation = static_cast<float>(transform.number("rotation", 0));
        uv_.used = image.has_value();
        if (image)
            material_.base_color_texture =
                texture_id(*image, info.required_index("index", loader_.textures.size(), "textures"));
    }

    /// A texture without effect: noted, and its image looked at, since a broken one should not pass unnoticed.
    void ignore(const JsonView& parent, const char* key, const char* sentence) {
        if (!parent.has(key)) return;
        ++loader_.ignored[sentence];
        if (const auto image = image_of(parent.object(key)))
            check_image(loader_.file.image_bytes(*image), where(*image));
    }

    /// The image that a textureInfo shows; none (with a note) where only an extension's format is offered.
    std::optional<uint32_t> image_of(const JsonView& info) {
        const JsonView& texture = loader_.textures[info.required_index("index", loader_.textures.size(), "textures")];
        const std::optional<uint32_t> image = texture.index("source", loader_.file.image_count(), "images");
        if (!image) ++loader_.ignored["{} textures without a PNG or JPEG source ignored"];
        return image;
    }

    int texture_id(uint32_t image, uint32_t texture) {
        const std::optional<uint32_t> index =
            loader_.textures[texture].index("sampler", loader_.samplers.size(), "samplers");
        const JsonView sampler = index ? loader_.samplers[*index] : JsonView(nullptr, "default sampler");
        const Texture::Wrap u = wrap_mode(sampler, "wrapS"), v = wrap_mode(sampler, "wrapT");
        const bool nearest = sampler.count("magFilter", 9729) == 9728;
        const auto [entry, added] =
            loader_.texture_ids.try_emplace({image, int(u), int(v), nearest}, int(loader_.scene.textures.size()));
        if (added) {
            const JsonView& json = loader_.file.image(image);
            Texture decoded = decode_image(loader_.file.image_bytes(image), where(image));
            decoded.name = json.text("name", is_data_uri(json.text("uri", "data:")) ? "" : json.text("uri", ""));
            decoded.wrap_u = u;
            decoded.wrap_v = v;
            decoded.nearest = nearest;
            loader_.scene.textures.push_back(std::move(decoded));
        }
        return entry->second;
    }

    /// The place of an image in messages, with its file where it has one.
    std::string where(uint32_t image) const {
        const JsonView& json = loader_.file.image(image);
        const std::string uri = json.text("uri", "data:");
        return is_data_uri(uri) ? json.where() : fmt::format("{} ({})", json.where(), printable(uri, 80));
    }

    std::optional<glm::vec4> mean_of(const JsonView& parent, const char* key, bool srgb) {
        if (!parent.has(key)) return std::nullopt;
        const std::optional<uint32_t> image = image_of(parent.object(key));
        if (!image) return std::nullopt;
        return mean_texel(decode_image(loader_.file.image_bytes(*image), where(*image)), srgb);
    }

    GltfLoader& loader_;
    const JsonView& json_;
    JsonView extensions_;
    Material material_;
    UvSource uv_;
};

}  // namespace

void GltfLoader::read_materials() {
    const std::vector<JsonView> materials = file.root().objects("materials");
    for (const JsonView& json : materials) MaterialReader(*this, json).read();
    Material fallback;
    fallback.name = "default";
    fallback.metallic = 1;  // the format's defaults
    scene.materials.push_back(std::move(fallback));
    uv_sources.emplace_back();
}

}  // namespace peelray
