// The parts of the glTF loader and what they share.
#pragma once

#include <glm/glm.hpp>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "loaders/gltf_check.h"
#include "loaders/gltf_file.h"
#include "scene/scene.h"

namespace peelray {

/// Where a material takes its base colour's coordinates from.
struct UvSource {
    uint32_t set = 0;
    glm::vec2 offset{0}, scale{1};
    float rotation = 0;  ///< radians
    bool used = false;   ///< false: the material has no base-colour texture
};

struct GltfLoader {
    GltfFile file;
    Scene scene;
    Tally ignored;
    std::vector<UvSource> uv_sources;                            ///< per material
    std::map<std::tuple<int, int, int, bool>, int> texture_ids;  ///< image, wraps, nearest → Scene::textures
    std::map<int, std::string> damaged_images;                   ///< and what is wrong with them
    size_t compressed = 0;                                       ///< primitives whose positions only Draco's data holds
    uint64_t triangles = 0;                                      ///< in all primitives read so far

    explicit GltfLoader(const std::filesystem::path& path) : file(path) {}

    void read_extensions();          // gltf.cpp
    void read_skins();               // gltf_animation.cpp
    void read_animations();          // gltf_animation.cpp
    void refuse_compressed();        // gltf.cpp
    void write_notes();              // gltf.cpp
    void read_materials();           // gltf_material.cpp; adds the default material at the end
    void read_mesh(uint32_t index);  // gltf_mesh.cpp
    /// Of a mesh's first primitive, as the file says.
    size_t target_count(uint32_t mesh) const;
    void read_nodes();  // gltf_node.cpp; also reads the meshes, cameras and lights that they show
};

/// Reads a .gltf or .glb file.
Scene load_gltf(const std::filesystem::path& path);

}  // namespace peelray
