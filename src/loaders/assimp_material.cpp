#include <assimp/ObjMaterial.h>
#include <assimp/material.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/error.h"
#include "base/text.h"
#include "loaders/assimp_loader.h"
#include "loaders/files.h"
#include "loaders/images.h"

namespace peelray {

namespace {

std::optional<float> number(const aiMaterial& from, const char* key, unsigned type, unsigned index) {
    ai_real value = 0;
    if (from.Get(key, type, index, value) != aiReturn_SUCCESS || !std::isfinite(value)) return std::nullopt;
    return static_cast<float>(value);
}

glm::vec3 color(const aiMaterial& from, const char* key, unsigned type, unsigned index, const glm::vec3& missing) {
    aiColor3D value;
    if (from.Get(key, type, index, value) != aiReturn_SUCCESS) return missing;
    const glm::vec3 out(value.r, value.g, value.b);
    return std::isfinite(out.x + out.y + out.z) ? glm::max(out, glm::vec3(0)) : missing;
}

float largest(const glm::vec3& v) {
    return std::max({v.x, v.y, v.z});
}

void read_texture(const aiMaterial& from, const std::filesystem::path& folder, Scene& scene, Material& out) {
    aiString name;
    if (from.GetTexture(aiTextureType_DIFFUSE, 0, &name) != aiReturn_SUCCESS) return;
    std::string relative = name.C_Str();
    std::replace(relative.begin(), relative.end(), '\\', '/');
    // aiString cannot hold long names; two materials may share a texture.
    for (size_t i = 0; i < scene.textures.size(); ++i)
        if (scene.textures[i].name == relative) out.base_color_texture = static_cast<int>(i);
    if (out.base_color_texture >= 0) return;
    try {
        const std::string where = fmt::format("texture \"{}\"", printable(relative, 80));
        const std::filesystem::path path = resolve_inside(folder, relative, where);
        Texture texture = decode_image(read_file(path), where);
        remember_file(scene.files, path);
        texture.name = relative;
        out.base_color_texture = static_cast<int>(scene.textures.size());
        scene.textures.push_back(std::move(texture));
    } catch (const Error& error) {
        scene.notes.push_back(
            fmt::format("texture of material \"{}\" ignored: {}", printable(out.name, 60), error.what()));
    }
}

/// illum 4, 6, 7 and 9 are the glasses; 6 and 7 bend the ray (a body), 4 and 9 let it through straight (a sheet).
void read_transmission(const aiMaterial& from, int illum, Material& out) {
    const float opacity = std::clamp(number(from, AI_MATKEY_OPACITY).value_or(1.f), 0.f, 1.f);
    const bool glass = illum == 4 || illum == 6 || illum == 7 || illum == 9;
    if (opacity >= 1 && !glass) return;
    out.transmission = opacity < 1 ? 1 - opacity : 1;
    const float index = number(from, AI_MATKEY_REFRACTI).value_or(1.f);
    out.ior = index > 1 ? std::min(index, 10.f) : 1.5f;  // Assimp says 1 where the file says nothing
    out.thickness = illum == 6 || illum == 7 ? 1.f : 0.f;
    out.metallic = 0;
    const glm::vec3 filter = color(from, AI_MATKEY_COLOR_TRANSPARENT, glm::vec3(1));
    out.base_color = largest(filter) > 0 ? glm::min(filter, glm::vec3(1)) : glm::vec3(1);
    // A clear body that says nothing of highlights is polished: glass is not frosted unless asked for.
    if (!number(from, AI_MATKEY_ROUGHNESS_FACTOR)) out.roughness = 0;
}

}  // namespace

Material convert_material(const aiMaterial& from, const std::filesystem::path& folder, Scene& scene) {
    Material out;
    out.name = from.GetName().C_Str();
    out.base_color = glm::min(color(from, AI_MATKEY_COLOR_DIFFUSE, glm::vec3(0.6f)), glm::vec3(1));
    out.emissive = color(from, AI_MATKEY_COLOR_EMISSIVE, glm::vec3(0));
    const glm::vec3 specular = glm::min(color(from, AI_MATKEY_COLOR_SPECULAR, glm::vec3(0)), glm::vec3(1));
    const float shininess = std::clamp(number(from, AI_MATKEY_SHININESS).value_or(0.f), 0.f, 1e5f);
    // Blinn's exponent n as GGX: alpha² = 2 / (n + 2), and alpha is the square of the roughness.
    if (largest(specular) > 0 && shininess > 0) out.roughness = std::pow(2.f / (shininess + 2.f), 0.25f);
    int illum = 2;
    if (from.Get(AI_MATKEY_OBJ_ILLUM, illum) != aiReturn_SUCCESS) illum = 2;
    const bool mirror = illum == 3 || illum == 5 || illum == 8;
    if (mirror && largest(specular) > 0) {
        out.metallic = 1;
        out.roughness = 0;
        out.base_color = specular;
    }
    if (const auto metallic = number(from, AI_MATKEY_METALLIC_FACTOR)) out.metallic = std::clamp(*metallic, 0.f, 1.f);
    if (const auto roughness = number(from, AI_MATKEY_ROUGHNESS_FACTOR))
        out.roughness = std::clamp(*roughness, 0.f, 1.f);
    read_transmission(from, illum, out);
    read_texture(from, folder, scene, out);
    return out;
}

}  // namespace peelray
