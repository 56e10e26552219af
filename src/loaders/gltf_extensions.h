// What a glTF file's extensions say of its buffers, meshes and textures: what tinygltf would decode itself, unchecked
// (it is built with Draco), or would not keep.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "loaders/meshopt.h"
#include "loaders/tally.h"

namespace peelray {

/// KHR_draco_mesh_compression of a primitive.
struct DracoSource {
    int view = -1;                               ///< the buffer view that holds the stream
    std::map<std::string, uint32_t> attributes;  ///< the stream's own numbers ("unique ids"), by glTF's names
};

struct GltfExtensions {
    struct CompressedView {
        size_t buffer = 0, offset = 0, length = 0;
        MeshoptLayout layout;
    };
    /// EXT_lights_image_based of the scene that is shown (gltf_image_light.h).
    struct ImageLight {
        std::string where;           ///< its place in messages
        std::array<int, 6> faces{};  ///< images of the largest level
        glm::dmat3 turn{1};
        double intensity = 1, size = 0;
    };
    std::optional<ImageLight> image_light;
    std::vector<std::optional<CompressedView>> compressed_views;         ///< one per buffer view
    std::vector<bool> fallback_buffers;                                  ///< one per buffer: nothing but fallbacks
    std::vector<std::vector<std::optional<DracoSource>>> draco_sources;  ///< one per mesh, in it one per primitive
    std::vector<std::string> variants;                                   ///< names, of KHR_materials_variants
    std::vector<std::vector<std::map<size_t, int>>> variant_materials;   ///< per mesh and primitive: by variant
};

/// Takes the extensions out of JSON that check_gltf() has checked. A texture's `source` becomes that of the format
/// which is read, where an extension offers several.
GltfExtensions take_extensions(nlohmann::json& checked, Tally& ignored);

}  // namespace peelray
