// The parts of the glTF loader and what they share.
#pragma once

#include <glm/glm.hpp>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "loaders/gltf_file.h"
#include "loaders/load.h"
#include "scene/origin.h"
#include "scene/scene.h"

namespace peelray {

struct GltfLoader {
    GltfFile file;
    Scene scene;
    Tally& ignored = file.ignored();
    std::vector<std::vector<uint32_t>> uv_sets;  ///< per material: the TEXCOORD_ that its textures use, as they count
    std::map<std::tuple<int, int, int, int, int>, int> texture_ids;  ///< image, wraps, filters → Scene::textures
    std::optional<size_t> variant;                                   ///< that which chooses the primitives' materials
    std::map<std::pair<int, float>, int> rough_textures;             ///< by one of glossiness and its factor
    float point_size = 0;                                            ///< LoadOptions::point_size
    std::map<uint32_t, uint32_t> unlit_copies;                       ///< of materials, by those
    std::map<int, std::string> damaged_images;                       ///< and what is wrong with them
    uint64_t triangles = 0;                                          ///< in all primitives read so far
    std::vector<ExactNode> exact_nodes;                              ///< of all nodes

    explicit GltfLoader(const std::filesystem::path& path) : file(path) {}

    void read_extensions();                        // gltf.cpp
    void choose_variant(const std::string& name);  // gltf.cpp
    void read_skins();                             // gltf_animation.cpp
    void read_animations();                        // gltf_animation.cpp
    void write_notes();                            // gltf.cpp
    void read_materials();                         // gltf_material.cpp; adds the default material at the end
    /// `scale`: how many world units one of the mesh's is long, for points and lines.
    void read_mesh(uint32_t index, double scale);  // gltf_mesh.cpp
    /// Throws Error where these are too many beside those so far.
    void check_triangles(uint64_t more, const std::string& where) const;
    /// The same material without light.
    uint32_t unlit(uint32_t material);  // gltf_material.cpp
    /// The file's number of a primitive's material, which a variant may choose; −1: the default one.
    int material_of(uint32_t mesh, size_t primitive) const;
    /// Of a mesh's first primitive, as the file says.
    size_t target_count(uint32_t mesh) const;
    void read_nodes();  // gltf_node.cpp; also the meshes, cameras and lights that they show, the latter without places
};

/// Reads a .gltf or .glb file.
Scene load_gltf(const std::filesystem::path& path, const LoadOptions& options);

}  // namespace peelray
