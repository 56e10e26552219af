#include "loaders/gltf_extensions.h"

#include <fmt/core.h>

#include <utility>

namespace peelray {

namespace {

using nlohmann::json;

/// An element's extension, which the element loses; nothing: it has none of that name.
std::optional<json> take(json& element, const char* name) {
    const auto extensions = element.find("extensions");
    if (extensions == element.end()) return std::nullopt;
    const auto found = extensions->find(name);
    if (found == extensions->end()) return std::nullopt;
    json out = std::move(*found);
    extensions->erase(found);
    return out;
}

std::optional<GltfExtensions::CompressedView> take_compressed_view(json& view) {
    for (const char* name : {"KHR_meshopt_compression", "EXT_meshopt_compression"}) {
        const std::optional<json> from = take(view, name);
        if (!from) continue;
        GltfExtensions::CompressedView out;
        out.buffer = from->at("buffer").get<size_t>();
        out.offset = from->value("byteOffset", size_t(0));
        out.length = from->at("byteLength").get<size_t>();
        out.layout.stride = from->at("byteStride").get<size_t>();
        out.layout.count = from->at("count").get<size_t>();
        out.layout.mode = from->at("mode").get<std::string>();
        out.layout.filter = from->value("filter", "NONE");
        return out;
    }
    return std::nullopt;
}

bool take_fallback_flag(json& buffer) {
    bool is_fallback = false;
    for (const char* name : {"KHR_meshopt_compression", "EXT_meshopt_compression"})
        if (const std::optional<json> from = take(buffer, name)) is_fallback |= from->value("fallback", false);
    return is_fallback;
}

std::optional<DracoSource> take_draco_source(json& primitive) {
    const std::optional<json> from = take(primitive, "KHR_draco_mesh_compression");
    if (!from) return std::nullopt;
    DracoSource out;
    out.view = from->at("bufferView").get<int>();
    for (const auto& [name, id] : from->at("attributes").items()) out.attributes[name] = id.get<uint32_t>();
    return out;
}

/// WebP before PNG and JPEG, both before what is not read: that counts only where there is nothing else.
void choose_source(json& texture, Tally& ignored) {
    if (const std::optional<json> webp = take(texture, "EXT_texture_webp"); webp && webp->contains("source"))
        texture["source"] = webp->at("source");
    for (const char* name : {"KHR_texture_basisu", "EXT_texture_avif", "MSFT_texture_dds"}) {
        const std::optional<json> other = take(texture, name);
        if (!other || !other->contains("source")) continue;
        if (texture.contains("source"))
            ++ignored[fmt::format("{{}} texture{{|s}} of {} shown by the other image that the file has for {{it|them}}",
                                  name)];
        else
            texture["source"] = other->at("source");
    }
}

std::vector<std::string> take_variants(json& root) {
    std::vector<std::string> out;
    if (const std::optional<json> from = take(root, "KHR_materials_variants"))
        for (const json& variant : from->value("variants", json::array())) out.push_back(variant.value("name", ""));
    return out;
}

std::map<size_t, int> take_variant_materials(json& primitive) {
    std::map<size_t, int> out;
    if (const std::optional<json> from = take(primitive, "KHR_materials_variants"))
        for (const json& mapping : from->value("mappings", json::array()))
            for (const json& variant : mapping.at("variants")) out[variant.get<size_t>()] = mapping.at("material");
    return out;
}

}  // namespace

GltfExtensions take_extensions(json& checked, Tally& ignored) {
    GltfExtensions out;
    for (json& view : checked["bufferViews"]) out.compressed_views.push_back(take_compressed_view(view));
    for (json& buffer : checked["buffers"]) out.fallback_buffers.push_back(take_fallback_flag(buffer));
    for (json& mesh : checked["meshes"]) {
        auto& sources = out.draco_sources.emplace_back();
        auto& materials = out.variant_materials.emplace_back();
        for (json& primitive : mesh["primitives"]) {
            sources.push_back(take_draco_source(primitive));
            materials.push_back(take_variant_materials(primitive));
        }
    }
    for (json& texture : checked["textures"]) choose_source(texture, ignored);
    out.variants = take_variants(checked);
    return out;
}

}  // namespace peelray
