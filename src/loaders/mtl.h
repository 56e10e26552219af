// Material libraries (MTL) of OBJ files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "loaders/images.h"
#include "loaders/tally.h"
#include "scene/scene.h"

namespace peelray {

/// A map_… statement.
struct MtlTexture {
    std::string name;         ///< as written, without quotes; a trailing comment may be part of it
    glm::vec2 scale{1};       ///< -s: texture coordinates times this
    glm::vec2 offset{0};      ///< -o: plus this
    bool is_clamped = false;  ///< -clamp on
    char channel = 0;         ///< -imfchan: r, g, b, m (alpha), l (luminance), z; 0: none given
    float strength = 1;       ///< -bm, of a normal map
};

/// A newmtl block: what this loader uses of it.
struct MtlMaterial {
    std::string name;  ///< as written after newmtl, with a trailing comment if there is one
    std::optional<glm::vec3> diffuse, specular, emissive, filter;  ///< Kd, Ks, Ke, Tf; linear, ≥ 0
    std::optional<float> shininess, ior, dissolve, transparency;   ///< Ns, Ni, d, Tr
    std::optional<float> roughness, metallic;                      ///< Pr, Pm
    std::optional<float> coat, coat_roughness;                     ///< Pc, Pcr
    int illum = 2;
    std::optional<MtlTexture> diffuse_map, emissive_map, dissolve_map, roughness_map, metallic_map, normal_map;
};

/// Reads the text of a library. What cannot be read or has no effect is counted in `tally`; `name` is the file's.
std::vector<MtlMaterial> parse_mtl(std::string_view text, const std::string& name, Tally& tally);

/// A map_… statement's options and name. Options without effect are counted. `is_normal`: of a normal map.
MtlTexture parse_mtl_texture(std::string_view rest, Tally& tally, bool is_normal = false);

/// Materials and textures of a scene out of those of its libraries.
class MtlConverter {
  public:
    /// `folder`: where the libraries and textures lie.
    MtlConverter(const std::filesystem::path& folder, Scene& scene) : folder_(folder), scene_(scene) {}

    Tally tally;

    /// Appends the material to the scene's, and the textures that it needs.
    void add(const MtlMaterial& from);
    /// Adds the tally to the scene's notes, and the images that are missing.
    void write_notes();

  private:
    std::optional<std::filesystem::path> find_image(const MtlTexture& map);
    std::optional<Texture> image(const MtlTexture& map, Depth depth = Depth::eight);
    int add_texture(const std::string& key, Texture texture, const MtlTexture& map);
    MaterialTexture use(const std::optional<MtlTexture>& map, Depth depth = Depth::eight);
    void read_surface(const MtlMaterial& from, Material& out);
    void read_transmission(const MtlMaterial& from, float opacity, Material& out);
    void read_color_map(const MtlMaterial& from, Material& out);
    float read_dissolve_map(const MtlMaterial& from, Material& out);

    std::filesystem::path folder_;
    Scene& scene_;
    std::map<std::string, int> textures_;             ///< Scene::textures by image and how it is used
    std::set<std::string> refused_;                   ///< names of images that could not be had, noted already
    std::vector<std::string> missing_, transparent_;  ///< names of images, of materials
};

}  // namespace peelray
