// Makes glTF files whose geometry is compressed, with the encoders of the libraries that decode it.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "loaders/scene_files.h"

namespace peelray::testing {

/// A wavy grid of `side`² vertices over the unit square, two triangles to a cell, whose attributes follow from the
/// position: the texture coordinates are x and y.
struct Grid {
    explicit Grid(uint32_t side);
    std::vector<float> positions, normals, uvs;
    std::vector<uint32_t> corners;
    size_t vertices() const { return positions.size() / 3; }
};

enum class DracoMethod { sequential, edgebreaker, valence };

/// Compresses a mesh with Draco, and describes it as a glTF primitive does.
class DracoWriter {
  public:
    explicit DracoWriter(std::vector<uint32_t> corners) : corners_(std::move(corners)) {}

    /// `type`: glTF's component type. `bits`: how finely floats are quantised, 0: not at all.
    template <typename T>
    void add(const std::string& name, int type, const char* shape, const std::vector<T>& values,
             bool normalized = false, int bits = 0) {
        attributes_.push_back({name, shape, pack(values), type, bits, normalized});
    }

    std::string stream(DracoMethod method) const;
    /// A file of one such primitive whose accessors have no bytes of their own. Compressed bytes other than those of
    /// stream() may be put in.
    json file(const std::string& stream) const;
    /// The same mesh, uncompressed.
    json plain() const;

  private:
    struct Attribute {
        std::string name, shape, bytes;
        int type, bits;
        bool normalized;
        uint32_t id(size_t index) const { return static_cast<uint32_t>(3 * index + 1); }  // not the index itself
    };
    size_t vertices() const;

    std::vector<uint32_t> corners_;
    std::vector<Attribute> attributes_;
};

/// The grid with normals and texture coordinates.
DracoWriter grid_writer(const Grid& grid, int bits);

/// Compresses the buffer view of an accessor in place, its buffer becomes a fallback without bytes. `stride`: bytes of
/// an element. Attributes are compressed as they are; a filter's input comes from meshopt_filtered().
void compress_view(json& gltf, size_t accessor, const std::string& bytes, size_t stride, const char* mode,
                   const char* filter = "NONE");
std::string meshopt_stream(const std::string& bytes, size_t stride, const std::string& mode);

/// Version 1 of the attributes' stream, which the library's encoder does not make. `channels`: a mode for every four
/// bytes of an element; `controls`: 0, 1 or 3 for each of its bytes, 2 where nothing ever changes is chosen by itself.
std::string meshopt_stream_1(const std::string& bytes, size_t stride, const std::vector<uint8_t>& channels,
                             const std::vector<int>& controls);

/// Values as a filter of that name stores them: four to an element, for EXPONENTIAL as many as there are.
std::string meshopt_filtered(const std::vector<float>& values, size_t stride, const std::string& filter, int bits);

/// The compressed file shows what Box.glb beside it does; skipped where the models are not here.
inline void expect_like_box(const std::string& name, const std::filesystem::path& models) {
    if (!std::filesystem::exists(models)) GTEST_SKIP() << "no models at " << models << "; see shared/models/README.md";
    const Geometry box = flatten(load_scene((models / "Box.glb").string())),
                   compressed = flatten(load_scene((models / name).string()));
    EXPECT_EQ(compressed.triangles.size(), box.triangles.size());
    EXPECT_LT(glm::distance(compressed.lower, box.lower) + glm::distance(compressed.upper, box.upper), 1e-3f);
}

}  // namespace peelray::testing
