// Materials of MTL files as ours.
#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/text.h"
#include "loaders/files.h"
#include "loaders/images.h"
#include "loaders/mtl.h"
#include "loaders/text_lines.h"

namespace peelray {

namespace {

constexpr glm::vec3 default_color{0.6f};  // a material that says nothing of its colour

float largest_channel(const glm::vec3& v) {
    return std::max({v.x, v.y, v.z});
}

float clamped(float value) {
    return std::clamp(value, 0.f, 1.f);
}

/// "a", "b" and so on, at most five of them.
std::string listed(const std::vector<std::string>& names) {
    std::string out;
    for (size_t i = 0; i < names.size() && i < 5; ++i)
        out += fmt::format("{}\"{}\"", i ? ", " : "", printable(names[i], 80));
    return names.size() > 5 ? out + " ..." : out;
}

uint8_t channel_of(uint32_t texel, char channel) {
    const uint32_t r = texel & 255, g = texel >> 8 & 255, b = texel >> 16 & 255, a = texel >> 24;
    switch (channel) {
        case 'r':
            return static_cast<uint8_t>(r);
        case 'g':
            return static_cast<uint8_t>(g);
        case 'b':
            return static_cast<uint8_t>(b);
        case 'm':
            return static_cast<uint8_t>(a);
        default:
            return static_cast<uint8_t>((2126 * r + 7152 * g + 722 * b + 5000) / 10000);
    }
}

bool is_opaque(const Texture& texture) {
    return std::all_of(texture.texels.begin(), texture.texels.end(), [](uint32_t t) { return t >> 24 == 255; });
}

/// The colours of one image with the opacity of another one, at the size of the larger.
Texture with_alpha(const Texture& color, const Texture& opacity, char channel) {
    Texture out = color;
    if (size_t(opacity.width) * opacity.height > size_t(color.width) * color.height) {
        out.width = opacity.width;
        out.height = opacity.height;
    }
    out.texels.resize(size_t(out.width) * out.height);
    const auto at = [&](const Texture& from, uint32_t x, uint32_t y) {
        const auto fx = static_cast<uint32_t>(uint64_t(x) * from.width / out.width),
                   fy = static_cast<uint32_t>(uint64_t(y) * from.height / out.height);
        return from.texels[size_t(fy) * from.width + fx];
    };
    for (uint32_t y = 0; y < out.height; ++y)
        for (uint32_t x = 0; x < out.width; ++x) {
            const uint32_t rgb = (color.texels.empty() ? 0xFFFFFFu : at(color, x, y)) & 0xFFFFFF;
            out.texels[size_t(y) * out.width + x] = rgb | uint32_t(channel_of(at(opacity, x, y), channel)) << 24;
        }
    return out;
}

/// The texture as a statement's options place it. They count v from the image's last row, we from its first.
MaterialTexture placed(int texture, const MtlTexture& map) {
    MaterialTexture out(texture);
    out.uv_matrix = glm::mat2(map.scale.x, 0, 0, map.scale.y);
    out.uv_offset = {map.offset.x, 1 - map.scale.y - map.offset.y};
    return out;
}

}  // namespace

/// The name as written, or what stands before a comment; nothing (noted once): it cannot be had.
std::optional<std::filesystem::path> MtlConverter::find_image(const MtlTexture& map) {
    for (const std::string& name : {map.name, std::string(name_without_comment(map.name))}) {
        const std::optional<SideFile> file = find_beside(folder_, name);
        if (!file) continue;
        if (file->is_elsewhere && refused_.insert(name).second)
            scene_.notes.push_back(fmt::format("the image \"{}\" was found as {} beside the model", printable(name, 80),
                                               printable(file->path.filename().string(), 80)));
        return file->path;
    }
    const std::string name(name_without_comment(map.name));
    if (!refused_.insert(name).second) return std::nullopt;
    try {
        std::string relative = name;
        std::replace(relative.begin(), relative.end(), '\\', '/');
        if (std::filesystem::path(relative).is_relative() && relative.find("..") != std::string::npos)
            resolve_inside(folder_, relative, fmt::format("texture \"{}\"", printable(name, 80)));
        missing_.push_back(name);
    } catch (const Error& error) {
        scene_.notes.push_back(fmt::format("the material's factor is used: {}", error.what()));
    }
    return std::nullopt;
}

std::optional<Texture> MtlConverter::image(const MtlTexture& map, Depth depth) {
    const std::optional<std::filesystem::path> path = find_image(map);
    if (!path) return std::nullopt;
    try {
        Texture texture = decode_image(read_file(*path), fmt::format("texture \"{}\"", printable(map.name, 80)), depth);
        remember_file(scene_.files, *path);
        texture.name = name_without_comment(map.name);
        std::replace(texture.name.begin(), texture.name.end(), '\\', '/');
        return texture;
    } catch (const Error& error) {
        if (refused_.insert(path->string()).second)
            scene_.notes.push_back(fmt::format("the material's factor is used: {}", error.what()));
        return std::nullopt;
    }
}

int MtlConverter::add_texture(const std::string& key, Texture texture, const MtlTexture& map) {
    if (map.is_clamped) texture.wrap_u = texture.wrap_v = Texture::Wrap::clamp;
    const int id = static_cast<int>(scene_.textures.size());
    textures_[key] = id;
    scene_.textures.push_back(std::move(texture));
    return id;
}

/// A texture of its own for a material's property, which the statement's options place; none where there is no image.
MaterialTexture MtlConverter::use(const std::optional<MtlTexture>& map, Depth depth) {
    if (!map) return {};
    std::string key = fmt::format("{}|{}", map->name, map->is_clamped);
    if (depth == Depth::as_stored) key += "|deep";
    auto known = textures_.find(key);
    if (known == textures_.end()) {
        std::optional<Texture> texture = image(*map, depth);
        if (!texture) return {};
        add_texture(key, std::move(*texture), *map);
        known = textures_.find(key);
    }
    MaterialTexture out = placed(known->second, *map);
    out.channel = map->channel == 'g' ? 1 : map->channel == 'b' ? 2 : map->channel == 'm' ? 3 : 0;
    return out;
}

void MtlConverter::read_surface(const MtlMaterial& from, Material& out) {
    out.base_color = from.diffuse.value_or(out.base_color_texture ? glm::vec3(1) : default_color);
    const glm::vec3 specular = from.specular.value_or(glm::vec3(0));
    if (largest_channel(out.base_color) > 1 || largest_channel(specular) > 1)
        ++tally["{} material{|s} with colours above 1 cut to that"];
    out.base_color = glm::min(out.base_color, glm::vec3(1));
    const float shininess = std::clamp(from.shininess.value_or(0.f), 0.f, 1e5f);
    // Blinn's exponent n as GGX: alpha² = 2 / (n + 2), and alpha is the square of the roughness.
    if (largest_channel(specular) > 0 && shininess > 0) out.roughness = std::pow(2.f / (shininess + 2.f), 0.25f);
    const bool is_mirror = from.illum == 3 || from.illum == 5 || from.illum == 8;
    if (is_mirror && largest_channel(specular) > 0) {
        out.metallic = 1;
        out.roughness = 0;
        out.base_color = glm::min(specular, glm::vec3(1));
    }
    if (from.metallic) out.metallic = clamped(*from.metallic);
    if (from.roughness) out.roughness = clamped(*from.roughness);
    // A factor beside a texture scales it; without one the texture counts as it is.
    if ((out.metallic_texture = use(from.metallic_map))) out.metallic = clamped(from.metallic.value_or(1.f));
    if ((out.roughness_texture = use(from.roughness_map))) out.roughness = clamped(from.roughness.value_or(1.f));
    out.clearcoat = clamped(from.coat.value_or(0.f));
    out.coat_roughness = clamped(from.coat_roughness.value_or(0.f));
    out.emissive_texture = use(from.emissive_map);
    out.emissive = from.emissive.value_or(glm::vec3(out.emissive_texture ? 1.f : 0.f));
    if ((out.normal_texture = use(from.normal_map, Depth::as_stored))) out.normal_scale = from.normal_map->strength;
    if (from.illum == 0) ++tally["{} material{|s} of constant colour (illum 0) lit as others"];
    if (from.illum == 10) ++tally["{} material{|s} that {shows|show} shadows only (illum 10) drawn as others"];
}

/// illum 4, 6, 7 and 9 are the glasses; 6 and 7 bend the ray (a body), 4 and 9 let it through straight (a sheet). What
/// is dissolved otherwise covers what is behind it by its opacity. Where Tf tints that, or the colour's texture has an
/// alpha that does not count, it is a sheet of glass that shows its own colour by the one share and what is behind by
/// the other.
void MtlConverter::read_transmission(const MtlMaterial& from, float opacity, Material& out) {
    const bool is_glass = from.illum == 4 || from.illum == 6 || from.illum == 7 || from.illum == 9;
    glm::vec3 filter = glm::min(from.filter.value_or(glm::vec3(1)), glm::vec3(1));
    if (opacity >= 1 && !is_glass) {
        const bool says_nothing = largest_channel(filter) == 0 || filter == glm::vec3(1);
        if (!says_nothing) ++tally["{} transmission filter{|s} (Tf) of materials that are opaque ignored"];
        return;
    }
    if (largest_channel(filter) == 0) {
        ++tally["{} black transmission filter{|s} (Tf) ignored"];
        filter = glm::vec3(1);
    }
    const MaterialTexture& texture = out.base_color_texture;
    const bool is_whole = !texture || is_opaque(scene_.textures[size_t(texture.texture)]);
    if (!is_glass && opacity > 0 && filter == glm::vec3(1) && is_whole) {
        out.alpha = opacity;
        out.blended = true;
        return;
    }
    const glm::vec3 own = from.diffuse.value_or(out.base_color_texture ? glm::vec3(1) : default_color);
    const float through = opacity < 1 ? 1 - opacity : 1;
    if (opacity >= 1 && from.diffuse && largest_channel(own) > 0)
        ++tally["{} glass{|es} (illum 4, 6, 7 or 9 without d) whose colour Kd is ignored; Tf tints {it|them}"];
    if (opacity <= 0 && !is_glass) transparent_.push_back(from.name);
    out.transmission = through;
    out.ior = from.ior.value_or(1.f) > 1 ? std::min(*from.ior, 10.f) : 1.5f;
    out.thickness = from.illum == 6 || from.illum == 7 ? 1.f : 0.f;
    out.metallic = 0;
    out.metallic_texture = {};
    // One colour tints both shares: this one makes their sum right under even light, and each where the other is none.
    out.base_color = glm::min(own, glm::vec3(1)) * (1 - through) + filter * through;
    // A clear body that says nothing of highlights is polished: glass is not frosted unless asked for.
    if (!from.roughness && !from.roughness_map) out.roughness = 0;
}

void MtlConverter::read_color_map(const MtlMaterial& from, Material& out) {
    if (!from.diffuse_map) return;
    const MtlTexture& map = *from.diffuse_map;
    const std::string key = fmt::format("{}|{}", map.name, map.is_clamped);
    const auto known = textures_.find(key);
    if (known != textures_.end()) {
        out.base_color_texture = placed(known->second, map);
    } else if (std::optional<Texture> texture = image(map)) {
        if (!from.dissolve_map && !is_opaque(*texture))
            ++tally["{} colour texture{|s} whose alpha is ignored; name the image after map_d, too"];
        out.base_color_texture = placed(add_texture(key, std::move(*texture), map), map);
    }
    if (out.base_color_texture && map.channel) ++tally["{} texture option{|s} \"-imfchan\" of colours without effect"];
}

/// Holes where the map is below one half; the mean of a map that never crosses it, which dissolves the surface evenly.
float MtlConverter::read_dissolve_map(const MtlMaterial& from, Material& out) {
    if (!from.dissolve_map) return 1;
    const MtlTexture& map = *from.dissolve_map;
    const std::optional<Texture> opacity = image(map);
    if (!opacity) return 1;
    const char channel = map.channel ? map.channel : is_opaque(*opacity) ? 'l' : 'm';
    size_t holes = 0;
    double sum = 0;
    for (const uint32_t texel : opacity->texels) {
        holes += channel_of(texel, channel) < 128;
        sum += channel_of(texel, channel) / 255.0;
    }
    if (holes == 0 || holes == opacity->texels.size()) {
        const auto mean = static_cast<float>(sum / static_cast<double>(opacity->texels.size()));
        if (mean < 1) ++tally["{} dissolve texture{|s} (map_d) replaced by {its|their} mean"];
        return mean;
    }
    ++tally["{} dissolve texture{|s} (map_d) {cuts|cut} holes where {it is|they are} below one half"];
    const bool is_textured(out.base_color_texture);
    const MtlTexture& shape = is_textured ? *from.diffuse_map : map;
    if (shape.scale != map.scale || shape.offset != map.offset)
        ++tally["{} texture option{|s} \"-s\" and \"-o\" of map_d that {differs|differ} from those of map_Kd ignored"];
    const std::string key =
        fmt::format("{}|{}|{}|{}", is_textured ? from.diffuse_map->name : "", map.name, channel, shape.is_clamped);
    const auto known = textures_.find(key);
    if (known != textures_.end()) {
        out.base_color_texture = placed(known->second, shape);
    } else {
        const Texture color = is_textured ? scene_.textures[size_t(out.base_color_texture.texture)] : Texture{map.name};
        out.base_color_texture = placed(add_texture(key, with_alpha(color, *opacity, channel), shape), shape);
    }
    out.alpha_cutoff = 0.5f;
    return 1;
}

void MtlConverter::add(const MtlMaterial& from) {
    Material out;
    out.name = from.name;
    read_color_map(from, out);
    read_surface(from, out);
    const float opacity = clamped(from.dissolve.value_or(1 - from.transparency.value_or(0.f)));
    if (from.dissolve && from.transparency && std::abs(opacity - (1 - *from.transparency)) > 0.01f)
        ++tally["{} material{|s} whose d and Tr disagree: d counts"];
    read_transmission(from, opacity * read_dissolve_map(from, out), out);
    scene_.materials.push_back(std::move(out));
}

void MtlConverter::write_notes() {
    if (missing_.size() == 1)
        scene_.notes.push_back(fmt::format("the image {} is missing; the material's factor is used", listed(missing_)));
    if (missing_.size() > 1)
        scene_.notes.push_back(fmt::format("{} images are missing, the materials' factors are used: {}",
                                           missing_.size(), listed(missing_)));
    if (!transparent_.empty())
        scene_.notes.push_back(fmt::format("{} wholly transparent (d 0 or Tr 1): {}",
                                           counted("{} material{|s} {is|are}", transparent_.size()),
                                           listed(transparent_)));
    add_notes(tally, scene_.notes);
}

}  // namespace peelray
