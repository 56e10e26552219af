// A glTF 2.0 file: its JSON, and its buffers, views, accessors and images with every range checked before it is read.
//
// Own code instead of tinygltf 2.7: that library refuses legal files (external buffers longer than byteLength, indices
// without a buffer view), reads values of the wrong type as defaults, and gives no place for an error message.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scene/files.h"
#include "scene/json_view.h"

namespace peelray {

class GltfFile {
  public:
    /// Reads .gltf or .glb (told apart by the first bytes). Throws Error for what is not glTF 2.x or is truncated.
    explicit GltfFile(const std::filesystem::path& path);
    GltfFile(const GltfFile&) = delete;
    GltfFile& operator=(const GltfFile&) = delete;

    const std::string& name() const { return name_; }  ///< the file's name without folder, for messages
    JsonView root() const { return {&json_, name_}; }

    struct Accessor {
        std::string where;
        uint32_t count = 0;
        uint32_t components = 0;      ///< 1 to 4 (SCALAR to VEC4), 4, 9, 16 for matrices
        uint32_t component_type = 0;  ///< 5120 to 5126
        bool normalized = false;
    };
    size_t accessor_count() const { return accessors_.size(); }
    const JsonView& accessor_json(uint32_t index) const { return accessors_[index]; }
    /// What an accessor says about itself; its data is not touched.
    Accessor accessor(uint32_t index) const;
    /// All components of all elements, normalised integers as [0, 1] or [-1, 1]. Throws Error for what is out of range.
    std::vector<float> floats(uint32_t index);
    /// A scalar accessor of unsigned integers (vertex indices).
    std::vector<uint32_t> integers(uint32_t index);

    /// The bytes of an image (external file, data URI or buffer view).
    std::span<const uint8_t> image_bytes(uint32_t index);
    size_t image_count() const { return images_.size(); }
    const JsonView& image(uint32_t index) const { return images_[index]; }

  private:
    struct Elements {  ///< where the elements of an accessor lie; no data: all zero
        std::span<const uint8_t> data;
        size_t stride = 0;
    };
    void parse(const std::filesystem::path& path);
    std::span<const uint8_t> split_glb();
    std::span<const uint8_t> buffer(uint32_t index);
    std::span<const uint8_t> view(uint32_t index);
    Elements elements(const JsonView& json, const Accessor& accessor, uint64_t count, size_t element_size);
    template <typename Store>
    void read(uint32_t index, const Accessor& accessor, Store store);
    template <typename Store>
    void read_sparse(const JsonView& json, const Accessor& accessor, Store store);
    void spend(const Accessor& accessor);

    std::string name_;
    std::filesystem::path folder_;
    Bytes bytes_;
    std::optional<std::span<const uint8_t>> glb_chunk_;
    nlohmann::json json_;
    std::vector<JsonView> buffers_, views_, accessors_, images_;
    std::vector<std::optional<Bytes>> loaded_buffers_, loaded_images_;
    uint64_t decoded_ = 0;  ///< components decoded so far, see spend()
};

}  // namespace peelray
