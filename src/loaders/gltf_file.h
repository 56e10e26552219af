// A glTF 2.0 file: tinygltf's model of it, and its accessors and images with every range checked before it is read.
//
// tinygltf parses; check_gltf looks at the JSON before it. Whatever tinygltf wants to read comes from our own reader,
// which stays in the file's folder, and images are left undecoded until somebody asks for one.
#pragma once

#include <tiny_gltf.h>

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/error.h"
#include "loaders/files.h"
#include "loaders/gltf_extensions.h"
#include "loaders/tally.h"

namespace peelray {

class GltfFile {
  public:
    /// Reads .gltf or .glb (told apart by the first bytes). Throws Error for what is not glTF 2.x or is truncated.
    explicit GltfFile(const std::filesystem::path& path);
    GltfFile(const GltfFile&) = delete;
    GltfFile& operator=(const GltfFile&) = delete;

    const std::string& name() const { return name_; }  ///< the file's name without folder, for messages
    /// The files that were read so far, this one first.
    const std::vector<std::filesystem::path>& files() const { return files_; }
    /// All indices in it are in range, and vectors have the format's length or none at all.
    const tinygltf::Model& model() const { return model_; }
    const GltfExtensions& extensions() const { return extensions_; }
    /// What reading the file so far had to pass over, and what is invalid about it and no reason to refuse it.
    Tally& ignored() { return ignored_; }
    /// The place of an element in messages: "box.gltf.meshes[3]".
    std::string where(const char* list, size_t index) const { return fmt::format("{}.{}[{}]", name_, list, index); }

    struct Accessor {
        std::string where;
        uint32_t count = 0;
        uint32_t components = 0;      ///< 1 to 4 (SCALAR to VEC4), 4, 9, 16 for matrices
        uint32_t component_type = 0;  ///< 5120 to 5126
        bool normalized = false;      ///< integers that stand for [0, 1] or [-1, 1]
        bool is_backed = false;       ///< false: no bytes behind it, all of it is zero
        bool is_float() const { return component_type == 5126; }
        double largest() const;  ///< of its component type, an integer: what stands for 1 if normalised
    };
    /// What an accessor says about itself; its data is not touched.
    Accessor accessor(int index) const;
    /// All components of all elements, normalised integers as [0, 1] or [-1, 1]. Throws Error for what is out of range.
    std::vector<float> floats(int index);
    /// A scalar accessor of unsigned integers (vertex indices).
    std::vector<uint32_t> integers(int index);
    /// The bytes of a buffer view, decompressed. Throws Error for what is out of range or has no bytes.
    std::span<const uint8_t> view(int index);
    /// Counts the numbers of an accessor that was decoded elsewhere; throws Error when a file's become too many.
    void spend(const Accessor& accessor);

    /// The bytes of an image (external file, data URI or buffer view).
    std::span<const uint8_t> image_bytes(int index);
    /// True where the image is a file of its own that does not exist.
    bool is_image_missing(int index) const;
    /// The image's own file name; empty for data URIs and buffer views.
    std::string image_file(int index) const;

  private:
    struct Elements {  ///< where the elements of an accessor lie; no data: all zero
        std::span<const uint8_t> data;
        size_t stride = 0;
    };
    struct Glb {
        std::span<const uint8_t> json, binary;
    };
    Glb split_glb(std::span<const uint8_t> all);
    void hide_unknown_types(nlohmann::json& json);
    void take_uris(nlohmann::json& json, std::optional<size_t> glb_bytes);
    void load(const std::string& text, const Glb* glb);
    Bytes read_uri(const std::string& uri, const std::string& where);
    Bytes read_buffer(size_t index);
    bool has_data(size_t buffer);
    std::span<const uint8_t> bytes_of(const std::string& at, size_t buffer, uint64_t offset, uint64_t length);
    Bytes decompress(size_t view, const GltfExtensions::CompressedView& from);
    Elements elements(const std::string& where, int view_index, uint64_t offset, uint64_t count, size_t element_size);
    template <typename T, typename Load>
    std::vector<T> read(const tinygltf::Accessor& from, const Accessor& accessor, Load load);

    std::string name_;
    std::filesystem::path folder_;
    std::vector<std::filesystem::path> files_;
    tinygltf::Model model_;
    struct BufferSource {
        std::string uri;
        size_t length;
        bool has_data = true;  ///< false: neither a uri nor a GLB chunk, or a fallback that nobody has needed yet
    };
    std::vector<BufferSource> buffer_sources_;
    struct ImageSource {
        std::optional<std::string> uri;
        int view = -1;  ///< used where there is no uri; -1: none
    };
    std::vector<ImageSource> image_sources_;
    std::vector<std::optional<Bytes>> loaded_images_;
    GltfExtensions extensions_;
    std::map<size_t, Bytes> decompressed_;  ///< by buffer view
    Tally ignored_;
    std::map<size_t, std::string> foreign_accessors_;  ///< those of an unknown type, which nothing may read
    uint64_t decoded_ = 0;                             ///< components decoded so far, see spend()
};

}  // namespace peelray
