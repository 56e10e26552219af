// Stanford PLY: triangles, polygons and strips, in ASCII and both binary byte orders.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "loaders/file_reader.h"
#include "scene/scene.h"

namespace peelray {

enum class PlyType : uint8_t { int8, uint8, int16, uint16, int32, uint32, int64, uint64, float32, float64 };

/// Bytes of one value in a binary file.
size_t size_of(PlyType type);
bool is_floating(PlyType type);

struct PlyProperty {
    std::string name;
    PlyType type = PlyType::float32;
    std::optional<PlyType> count;  ///< of a list's length; nothing: a single value
};

struct PlyElement {
    std::string name;
    uint64_t count = 0;
    std::vector<PlyProperty> properties;
};

struct PlyHeader {
    enum class Format : uint8_t { ascii, little_endian, big_endian };
    Format format = Format::ascii;
    std::vector<PlyElement> elements;   ///< in the order of the file
    std::vector<std::string> textures;  ///< image files named by "comment TextureFile"

    const PlyElement* find(std::string_view name) const;
};

/// Reads the header; the reader stands at the first byte of the body then. Throws Error, naming the line, for one that
/// makes no sense.
PlyHeader read_ply_header(FileReader& file);

/// The values of a body, one after the other, whatever its format. Throws Error where the file ends too early.
class PlyBody {
  public:
    PlyBody(FileReader& file, PlyHeader::Format format) : file_(file), format_(format) {}

    double number(PlyType type);
    int64_t whole(PlyType type);
    /// A list's length, which the rest of the file can hold.
    uint64_t length(const PlyProperty& list);
    /// Goes past values that nobody wants.
    void skip(PlyType type, uint64_t count);
    /// Bytes that `count` elements take at least.
    double least_size(const PlyElement& element) const;
    bool is_ascii() const { return format_ == PlyHeader::Format::ascii; }
    /// "line 7" or "byte 120": where the last value ended.
    std::string place() const;

  private:
    uint64_t bits(PlyType type);

    FileReader& file_;
    PlyHeader::Format format_;
};

/// Reads the file and, from its folder, the textures that it names. Elements may come in any order. Throws Error (one
/// line: what, where, what to do) for files that are no PLY mesh, that end too early, that claim more than they hold,
/// whose faces name no vertex, and for point clouds. What has no effect becomes a note.
Scene load_ply(const std::filesystem::path& path);

}  // namespace peelray
